# Packages of a release, by cpack: Debian's (-G DEB: the command, the library to build with), and an archive that runs
# from any folder of any Linux with the same or a newer C library (-G TGZ, with POLHODE_RELOCATABLE).
# scripts/package.sh makes them all.
option(POLHODE_RELOCATABLE "Install the command with all its shared libraries but the C library" OFF)

if(POLHODE_RELOCATABLE AND TARGET polhode_cli)
  # The old tag holds for libraries of libraries as well, and for MUMPS, which is opened by name.
  set_target_properties(polhode_cli PROPERTIES INSTALL_RPATH "$ORIGIN/../lib/polhode")
  target_link_options(polhode_cli PRIVATE LINKER:--disable-new-dtags)
  install(CODE "set(program \"$<TARGET_FILE:polhode_cli>\")\nset(mumps \"${MUMPS_LIBRARY}\")\nset(mumps_name \"${MUMPS_SONAME}\")"
    COMPONENT command)
  install(SCRIPT ${PROJECT_SOURCE_DIR}/cmake/carry_libraries.cmake COMPONENT command)
endif()

set(CPACK_PACKAGE_NAME polhode)
set(CPACK_PACKAGE_VENDOR Polhode)
set(CPACK_PACKAGE_CONTACT "The Polhode authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Dynamics of rigid and flexible multibody systems, with exact conservation")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)

if(POLHODE_RELOCATABLE)
  set(CPACK_COMPONENTS_ALL command)
  set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
  set(CPACK_COMPONENT_INCLUDE_TOPLEVEL_DIRECTORY ON)
  set(CPACK_ARCHIVE_COMMAND_FILE_NAME
    polhode-${PROJECT_VERSION}-${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR})
else()
  set(CPACK_COMPONENTS_ALL command development)
  set(CPACK_DEB_COMPONENT_INSTALL ON)
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME polhode)
  set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpolhode-dev)
  set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
  set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "The library and its headers, to build programs with.")
  find_program(DPKG_QUERY dpkg-query)
  if(DPKG_QUERY)
    # Which package brings MUMPS is not seen in the program: it opens the library by name.
    execute_process(COMMAND ${DPKG_QUERY} -S ${MUMPS_FILE} OUTPUT_VARIABLE owner ERROR_QUIET
      OUTPUT_STRIP_TRAILING_WHITESPACE)
    string(REGEX REPLACE ":.*" "" owner "${owner}")
    # With another BLAS than here its results would differ in the last bits.
    set(CPACK_DEBIAN_COMMAND_PACKAGE_DEPENDS "${owner}, libopenblas0-pthread")
    set(needed libeigen3-dev libfmt-dev libyaml-cpp-dev libtinyxml2-dev libhdf5-dev nlohmann-json3-dev libssl-dev zlib1g-dev
      libsuitesparse-dev ${owner})
    list(JOIN needed ", " CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS)
  endif()
endif()
include(CPack)
