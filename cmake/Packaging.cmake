# cmake --install, and the Debian package that cpack makes of it (preset package, ./mortise package).
#
#   bin/mortise          the wrapper, by a link
#   share/mortise        the wrapper, and what its commands need, laid out as in the repository
#   libexec/mortise      the program and gmsh's functions
#   share/doc/mortise    README, licence, changes, and the documents by a link
include(GNUInstallDirs)
set(shared ${CMAKE_INSTALL_DATADIR}/mortise)

install(TARGETS mortise mortise_solver RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/mortise)
install(TARGETS mortise_gmsh LIBRARY DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/mortise)
install(PROGRAMS mortise DESTINATION ${shared})
install(DIRECTORY inputs docs DESTINATION ${shared} USE_SOURCE_PERMISSIONS PATTERN "*.out" EXCLUDE PATTERN "__pycache__" EXCLUDE)
install(DIRECTORY postproc DESTINATION ${shared} USE_SOURCE_PERMISSIONS PATTERN "__pycache__" EXCLUDE)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/mortise)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/mortise RENAME copyright)
install(CODE [[
  function(link_to target name)
    cmake_path(SET link "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${name}")
    cmake_path(GET link PARENT_PATH directory)
    file(MAKE_DIRECTORY ${directory})
    file(CREATE_LINK ${target} ${link} SYMBOLIC)
  endfunction()
  link_to(../share/mortise/mortise bin/mortise)
  link_to(../../mortise/docs share/doc/mortise/docs)
  link_to(../../mortise/inputs share/doc/mortise/examples)
]])

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME mortise)
set(CPACK_PACKAGE_VENDOR Mortise)
set(CPACK_PACKAGE_CONTACT "The Mortise team <mortise@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY ${PROJECT_DESCRIPTION})
set(CPACK_PACKAGE_DESCRIPTION "Contact of elastic bodies by Total FETI and boundary elements:
a mesh of gmsh, a short deck in YAML, fields for ParaView.

Needs a processor with AVX2 and FMA.")
set(CPACK_PACKAGE_FILE_NAME mortise_${PROJECT_VERSION}_amd64)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libopenblas0-serial, openmpi-bin, python3, python3-numpy, python3-yaml")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-vtk9, python3-matplotlib")
include(CPack)
