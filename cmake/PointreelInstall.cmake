# `cmake --install`: library, headers, tool, CMake package and pkg-config file.
include(CMakePackageConfigHelpers)

set(POINTREEL_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/pointreel)

install(
  TARGETS pointreel
  EXPORT pointreel
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/pointreel DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET pointreel_tool)
  install(TARGETS pointreel_tool DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

install(EXPORT pointreel NAMESPACE pointreel:: FILE pointreelTargets.cmake DESTINATION ${POINTREEL_CMAKE_DIR})
configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/pointreelConfig.cmake.in ${PROJECT_BINARY_DIR}/pointreelConfig.cmake
  INSTALL_DESTINATION ${POINTREEL_CMAKE_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pointreelConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pointreelConfig.cmake ${PROJECT_BINARY_DIR}/pointreelConfigVersion.cmake
        DESTINATION ${POINTREEL_CMAKE_DIR})

file(RELATIVE_PATH POINTREEL_PREFIX_FROM_PC /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(${CMAKE_CURRENT_LIST_DIR}/pointreel.pc.in ${PROJECT_BINARY_DIR}/pointreel.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/pointreel.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
