# Builds the ParaView plugin from this source in a CMake tree of its own, and installs it with the
# rest.
include(ExternalProject)

set(BSPC_PARAVIEW_BINARY_DIR "${CMAKE_BINARY_DIR}/paraview")
set(forwarded -DBSPC_WARNINGS_AS_ERRORS=${BSPC_WARNINGS_AS_ERRORS})
foreach(name CMAKE_BUILD_TYPE CMAKE_CXX_COMPILER CMAKE_C_COMPILER CMAKE_CXX_COMPILER_LAUNCHER
             CMAKE_CXX_FLAGS CMAKE_INSTALL_PREFIX CMAKE_INSTALL_LIBDIR ParaView_DIR)
  if(${name})
    list(APPEND forwarded "-D${name}=${${name}}")
  endif()
endforeach()

ExternalProject_Add(bspc_paraview_plugin
  SOURCE_DIR "${PROJECT_SOURCE_DIR}"
  BINARY_DIR "${BSPC_PARAVIEW_BINARY_DIR}"
  CMAKE_ARGS -DBSPC_PARAVIEW_SUBBUILD=ON ${forwarded}
  BUILD_ALWAYS ON
  INSTALL_COMMAND ""
  USES_TERMINAL_BUILD ON
)
install(CODE "
  execute_process(COMMAND \"${CMAKE_COMMAND}\" --install \"${BSPC_PARAVIEW_BINARY_DIR}\"
    --component plugin --prefix \"\${CMAKE_INSTALL_PREFIX}\" COMMAND_ERROR_IS_FATAL ANY)
" COMPONENT paraview)
