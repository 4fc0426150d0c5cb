# mortise_module(NAME USES module... LINKS library... SOURCES file... [TESTS file...] [STUDY_TESTS pattern...] [PARALLEL_TESTS file...])
#
# One module of lib/: a static library whose public headers lie in include/NAME, the others in src and its folders. It sees the
# headers of the modules it USES and of those which these use, and no others: an arrow that is not declared here does not compile.
# TESTS make one GoogleTest program, test_NAME, run on one rank; PARALLEL_TESTS make mpi_test_NAME, run on 1 and 3, and under the label
# study on 2. STUDY_TESTS are patterns of GoogleTest: what costs most of test_NAME, and runs under the label study alone. What tests
# of several modules stand on is in lib/testing: a header there compiles in tests of the modules that see all that it includes.
add_library(mortise_options INTERFACE)
target_compile_options(mortise_options INTERFACE -Wall -Wextra)
# The C++ bindings of MPI, which MPI itself has dropped, would be compiled into every file.
target_compile_definitions(mortise_options INTERFACE OMPI_SKIP_MPICXX)
# What Eigen wants inlined is so at once: clang would optimize each of these small functions first. g++ refuses some.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  target_compile_definitions(mortise_options INTERFACE "EIGEN_STRONG_INLINE=__attribute__((always_inline)) inline")
endif()
if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
  target_link_options(mortise_options INTERFACE -Wl,--version-script=${CMAKE_CURRENT_LIST_DIR}/hide_eigen.map)
endif()
if(MORTISE_ARCH)
  target_compile_options(mortise_options INTERFACE -march=${MORTISE_ARCH})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13 AND CMAKE_SYSTEM_PROCESSOR STREQUAL "x86_64")
    # It takes loads of whole vectors, in branches that fixed 3-vectors never enter, for overruns; its headers of AVX-512 warn
    # even of themselves (https://gcc.gnu.org/PR105593), and little is lost without.
    target_compile_options(mortise_options INTERFACE -mno-avx512f -Wno-array-bounds -Wno-stringop-overread -Wno-stringop-overflow)
  endif()
endif()
# A library that is loaded to look in itself first (gmsh's, lib/mesh) has to share variables such as std::cout with the program, which
# therefore keeps no copies of its own of other libraries' variables. The sanitizers' libraries do not go with that.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  set(no_copies -fno-direct-access-external-data)
else()
  set(no_copies -mno-direct-extern-access)
endif()
include(CheckCXXCompilerFlag)
check_cxx_compiler_flag(${no_copies} MORTISE_HAS_NO_COPIES)
if(MORTISE_HAS_NO_COPIES AND NOT MORTISE_SANITIZE)
  target_compile_options(mortise_options INTERFACE ${no_copies})
endif()
if(MORTISE_SANITIZE)
  target_compile_options(mortise_options INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer)
  target_link_options(mortise_options INTERFACE -fsanitize=address,undefined)
endif()
if(MORTISE_FUZZ_READERS)
  target_compile_options(mortise_options INTERFACE -fsanitize=fuzzer-no-link -fno-sanitize-recover=all)
endif()

# Headers of others that most files read, parsed once: Tpetra's alone took 7 of some 12 seconds a file. Two sets, so that a module without
# distributed vectors still does not see Trilinos. Off with -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON, as in the preset debug: what
# compiles there names all that it includes.
# The presets release and sanitize also compile the files of a target in batches (CMAKE_UNITY_BUILD), see docs/building.md.
#
# Tests are compiled with less optimization, which takes a third of their time away.
add_library(mortise_test_options INTERFACE)
target_link_libraries(mortise_test_options INTERFACE mortise_options)
target_compile_options(mortise_test_options INTERFACE $<$<CONFIG:Release>:-O1>)

# Levels of optimization in Release; all modules that are not named have that of CMAKE_CXX_FLAGS_RELEASE, -O3. At -O1, what runs once for a
# deck, a mesh or a state and takes little of a run's time; at -O2, what goes through all cells or facets by short loops, which -O3 hardly
# changes: see docs/building.md. With clang the level of a file is that of its command line; g++ takes it from the precompiled headers.
set(mortise_modules_O1 deck mesh partition constraint friction io model analysis output mortise_app mortise_solver)
set(mortise_modules_O2 contact fem post)

function(mortise_optimization target)
  foreach(level O1 O2)
    if(target IN_LIST mortise_modules_${level})
      target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-${level}>)
    endif()
  endforeach()
endfunction()

function(mortise_headers name)
  cmake_parse_arguments(arg "" "" "LINKS;HEADERS" ${ARGN})
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp CONTENT "")
  add_library(${name} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp)
  target_link_libraries(${name} PRIVATE ${arg_LINKS} mortise_options)
  target_precompile_headers(${name} PRIVATE ${arg_HEADERS})
  # CMake gives the file that names the headers the time of the top CMakeLists.txt, so another list here would go unseen.
  set_source_files_properties(${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${name}.dir/cmake_pch.hxx.cxx
    PROPERTIES OBJECT_DEPENDS ${CMAKE_CURRENT_FUNCTION_LIST_FILE})
endfunction()

set(common_headers <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <Eigen/SparseCore> ${CMAKE_SOURCE_DIR}/lib/base/include/base/eigen_kernels.hpp
    <fmt/format.h> <mpi.h> <nlohmann/json.hpp> <yaml-cpp/yaml.h>
    <algorithm> <array> <cmath> <functional> <map> <memory> <numeric> <optional> <string> <vector>)
set(common_links MPI::MPI_CXX Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json yaml-cpp)
mortise_headers(mortise_common_headers LINKS ${common_links} HEADERS ${common_headers})
mortise_headers(mortise_tpetra_headers
  LINKS ${common_links} mortise_tpetra
  HEADERS ${common_headers} <Tpetra_Core.hpp> <Tpetra_Import.hpp> <Tpetra_Map.hpp> <Tpetra_Operator.hpp> <Tpetra_Vector.hpp>)

# mortise_precompiled(TARGET module...) gives a target the set that fits the modules it links.
function(mortise_precompiled target)
  set(open ${ARGN})
  set(headers mortise_common_headers)
  while(open)
    list(POP_FRONT open module)
    if(module STREQUAL "base_tpetra")
      set(headers mortise_tpetra_headers)
      break()
    endif()
    if(TARGET ${module})
      get_target_property(further ${module} INTERFACE_LINK_LIBRARIES)
      if(further)
        list(APPEND open ${further})
      endif()
    endif()
  endwhile()
  target_precompile_headers(${target} REUSE_FROM ${headers})
endfunction()

function(mortise_module name)
  cmake_parse_arguments(arg "" "" "USES;LINKS;SOURCES;TESTS;STUDY_TESTS;PARALLEL_TESTS" ${ARGN})
  list(TRANSFORM arg_SOURCES PREPEND src/)
  add_library(${name} STATIC ${arg_SOURCES})
  set_target_properties(${name} PROPERTIES OUTPUT_NAME mortise_${name})
  target_include_directories(${name} PUBLIC include PRIVATE src)
  target_link_libraries(${name} PUBLIC ${arg_USES} ${arg_LINKS} PRIVATE mortise_options)
  mortise_precompiled(${name} ${arg_USES})
  mortise_optimization(${name})
  if(MORTISE_TESTS AND arg_TESTS)
    mortise_test_program(test_${name} ${name} ${arg_TESTS})
    if(arg_STUDY_TESTS)
      list(JOIN arg_STUDY_TESTS ":" patterns)
      add_test(NAME ${name} COMMAND test_${name} --gtest_filter=-${patterns})
      add_test(NAME ${name}.study COMMAND test_${name} --gtest_filter=${patterns})
      set_tests_properties(${name}.study PROPERTIES LABELS study)
    else()
      add_test(NAME ${name} COMMAND test_${name})
    endif()
  endif()
  if(MORTISE_TESTS AND arg_PARALLEL_TESTS)
    mortise_test_program(mpi_test_${name} ${name} ${arg_PARALLEL_TESTS})
    foreach(ranks 1 2 3)
      add_test(NAME ${name}.ranks${ranks}
               COMMAND ${MPIEXEC_EXECUTABLE} --oversubscribe -n ${ranks} $<TARGET_FILE:mpi_test_${name}>)
      set_tests_properties(${name}.ranks${ranks} PROPERTIES PROCESSORS ${ranks})
    endforeach()
    set_tests_properties(${name}.ranks2 PROPERTIES LABELS study)
  endif()
endfunction()

# The main of all test programs, which starts and ends MPI; on several ranks a test fails if it failed on any.
if(MORTISE_TESTS)
  add_library(mortise_test_main STATIC ${CMAKE_CURRENT_LIST_DIR}/test_main.cpp)
  target_link_libraries(mortise_test_main PUBLIC GTest::gtest MPI::MPI_CXX PRIVATE mortise_options)
endif()

function(mortise_test_program target module)
  list(TRANSFORM ARGN PREPEND test/ OUTPUT_VARIABLE sources)
  add_executable(${target} ${sources})
  target_link_libraries(${target} PRIVATE mortise_test_main ${module} base mortise_test_options)
  target_include_directories(${target} PRIVATE src ${CMAKE_SOURCE_DIR}/lib/testing/include)
  mortise_precompiled(${target} ${module})
  target_compile_definitions(${target} PRIVATE MORTISE_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
endfunction()
