# Installation and the package other projects find with find_package(polhode).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(POLHODE_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/polhode)

install(TARGETS polhode EXPORT polhodeTargets
  ARCHIVE COMPONENT development LIBRARY COMPONENT development FILE_SET HEADERS COMPONENT development)
if(TARGET polhode_cli)
  install(TARGETS polhode_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
endif()
install(EXPORT polhodeTargets NAMESPACE polhode:: DESTINATION ${POLHODE_PACKAGE_DIR} COMPONENT development)

configure_package_config_file(cmake/polhodeConfig.cmake.in polhodeConfig.cmake
  INSTALL_DESTINATION ${POLHODE_PACKAGE_DIR})
write_basic_package_version_file(polhodeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/polhodeConfig.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/polhodeConfigVersion.cmake
  DESTINATION ${POLHODE_PACKAGE_DIR} COMPONENT development)
install(FILES LICENSE THIRD_PARTY.md README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT command OPTIONAL)
include(cmake/package.cmake)
