# SPDX-License-Identifier: MIT
# Install and export: find_package(tunica), with tunica::zlib where zlib was and is there; pkg-config.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/tunica)

install(TARGETS tunica EXPORT tunica FILE_SET HEADERS)
install(EXPORT tunica NAMESPACE tunica:: FILE tunica-targets.cmake DESTINATION ${package_dir})
if(TARGET tunica_zlib)
  install(TARGETS tunica_zlib EXPORT tunica-zlib FILE_SET HEADERS)
  install(EXPORT tunica-zlib NAMESPACE tunica:: FILE tunica-zlib-targets.cmake DESTINATION ${package_dir})
endif()

configure_package_config_file(cmake/tunica-config.cmake.in ${PROJECT_BINARY_DIR}/tunica-config.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tunica-config-version.cmake
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${PROJECT_BINARY_DIR}/tunica-config.cmake ${PROJECT_BINARY_DIR}/tunica-config-version.cmake
  DESTINATION ${package_dir})

configure_file(cmake/tunica.pc.in ${PROJECT_BINARY_DIR}/tunica.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/tunica.pc DESTINATION ${CMAKE_INSTALL_DATADIR}/pkgconfig)
