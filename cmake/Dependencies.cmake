# Everything Mortise stands on, found once. Third-party headers are system headers: our warnings are about our code.
find_package(MPI REQUIRED COMPONENTS CXX)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
if(MORTISE_TESTS)
  find_package(GTest REQUIRED)
endif()

set(HDF5_PREFER_PARALLEL ON)
find_package(HDF5 REQUIRED COMPONENTS C)
if(NOT HDF5_IS_PARALLEL)
  message(FATAL_ERROR "HDF5 was found without MPI: install libhdf5-openmpi-dev")
endif()
add_library(mortise_hdf5 INTERFACE)
target_include_directories(mortise_hdf5 SYSTEM INTERFACE ${HDF5_C_INCLUDE_DIRS})
target_link_libraries(mortise_hdf5 INTERFACE ${HDF5_C_LIBRARIES})

find_package(VTK 9 REQUIRED COMPONENTS CommonCore CommonDataModel IOXML)

find_package(Tpetra REQUIRED)
add_library(mortise_tpetra INTERFACE)
target_include_directories(mortise_tpetra SYSTEM INTERFACE ${Tpetra_INCLUDE_DIRS} ${Tpetra_TPL_INCLUDE_DIRS})
target_link_libraries(mortise_tpetra INTERFACE ${Tpetra_LIBRARIES} ${Tpetra_TPL_LIBRARIES})

find_package(Amesos2 REQUIRED)
add_library(mortise_amesos2 INTERFACE)
target_include_directories(mortise_amesos2 SYSTEM INTERFACE ${Amesos2_INCLUDE_DIRS} ${Amesos2_TPL_INCLUDE_DIRS})
target_link_libraries(mortise_amesos2 INTERFACE ${Amesos2_LIBRARIES} mortise_tpetra)

find_library(METIS_LIBRARY metis REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(GMSH_LIBRARY gmsh REQUIRED)
find_library(MUPARSER_LIBRARY muparser REQUIRED)

# The reference BLAS makes everything several times slower: refuse it while it can still be mended. CHOLMOD loads
# libblas.so.3, which Debian's alternatives resolve to one of several libraries.
find_file(BLAS_RUNTIME libblas.so.3 PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE} REQUIRED)
file(REAL_PATH ${BLAS_RUNTIME} BLAS_RUNTIME_REAL)
if(NOT BLAS_RUNTIME_REAL MATCHES "openblas")
  message(FATAL_ERROR "libblas.so.3 is ${BLAS_RUNTIME_REAL}, not OpenBLAS: install libopenblas0-serial")
endif()
find_file(OPENBLAS_RUNTIME libopenblas.so.0 PATHS /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE})
if(NOT OPENBLAS_RUNTIME)
  set(OPENBLAS_RUNTIME "")
endif()
