# mortise_module(NAME USES module... LINKS library... SOURCES file... [TESTS file...] [PARALLEL_TESTS file...])
#
# One module of lib/: a static library whose public headers lie in include/NAME. It sees the headers of the modules it USES
# and of those which these use, and no others: an arrow that is not declared here does not compile.
# TESTS make one GoogleTest program, test_NAME, run on one rank; PARALLEL_TESTS make mpi_test_NAME, run on 1, 2 and 3.
add_library(mortise_options INTERFACE)
target_compile_options(mortise_options INTERFACE -Wall -Wextra)
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
if(MORTISE_SANITIZE)
  target_compile_options(mortise_options INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer)
  target_link_options(mortise_options INTERFACE -fsanitize=address,undefined)
endif()

function(mortise_module name)
  cmake_parse_arguments(arg "" "" "USES;LINKS;SOURCES;TESTS;PARALLEL_TESTS" ${ARGN})
  list(TRANSFORM arg_SOURCES PREPEND src/)
  add_library(${name} STATIC ${arg_SOURCES})
  set_target_properties(${name} PROPERTIES OUTPUT_NAME mortise_${name})
  target_include_directories(${name} PUBLIC include)
  target_link_libraries(${name} PUBLIC ${arg_USES} ${arg_LINKS} PRIVATE mortise_options)
  if(MORTISE_TESTS AND arg_TESTS)
    mortise_test_program(test_${name} ${name} ${arg_TESTS})
    add_test(NAME ${name} COMMAND test_${name})
  endif()
  if(MORTISE_TESTS AND arg_PARALLEL_TESTS)
    mortise_test_program(mpi_test_${name} ${name} ${arg_PARALLEL_TESTS})
    foreach(ranks 1 2 3)
      add_test(NAME ${name}.ranks${ranks}
               COMMAND ${MPIEXEC_EXECUTABLE} --oversubscribe -n ${ranks} $<TARGET_FILE:mpi_test_${name}>)
      set_tests_properties(${name}.ranks${ranks} PROPERTIES PROCESSORS ${ranks})
    endforeach()
  endif()
endfunction()

# A GoogleTest program with a main that starts and ends MPI; on several ranks a test fails if it failed on any.
function(mortise_test_program target module)
  list(TRANSFORM ARGN PREPEND test/ OUTPUT_VARIABLE sources)
  add_executable(${target} ${sources} ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/test_main.cpp)
  target_link_libraries(${target} PRIVATE ${module} base GTest::gtest mortise_options)
  target_compile_definitions(${target} PRIVATE MORTISE_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
endfunction()
