# What other projects find, and a Debian package of everything: cpack --config BUILD/CPackConfig.cmake
include(CMakePackageConfigHelpers)
set(BSPC_CMAKE_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/BSPC")
configure_package_config_file(
  "${CMAKE_CURRENT_LIST_DIR}/BSPCConfig.cmake.in" "${PROJECT_BINARY_DIR}/BSPCConfig.cmake"
  INSTALL_DESTINATION "${BSPC_CMAKE_DESTINATION}"
)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/BSPCConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion
)
install(
  FILES "${PROJECT_BINARY_DIR}/BSPCConfig.cmake" "${PROJECT_BINARY_DIR}/BSPCConfigVersion.cmake"
  DESTINATION "${BSPC_CMAKE_DESTINATION}"
)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The bspc maintainers")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# Which libraries the programs need is found out from them; the package's own are beside them.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}/lib")
if(BSPC_BUILD_PYTHON)
  set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3-vtk9, python3-numpy")
endif()
# What a project needs that is built on the installed library or modules.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libzstd-dev")
if(BSPC_BUILD_VTK)
  string(APPEND CPACK_DEBIAN_PACKAGE_SUGGESTS ", libvtk9-dev")
endif()
if(BSPC_BUILD_OPENMESH)
  string(APPEND CPACK_DEBIAN_PACKAGE_SUGGESTS ", libopenmesh-dev")
endif()
include(CPack)
