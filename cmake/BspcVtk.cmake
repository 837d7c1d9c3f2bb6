# The VTK modules and their Python package. Their vtk.module files know nothing of this file, so that
# another tree can take them up as well.
set(BSPC_VTK_MODULE_FILES
  "${CMAKE_CURRENT_SOURCE_DIR}/vtkBSPReader/vtk.module"
  "${CMAKE_CURRENT_SOURCE_DIR}/vtkBSPWriter/vtk.module"
)

set(BSPC_VTK_COMPONENTS
  CommonCore CommonDataModel CommonExecutionModel CommonMisc FiltersSources IOCore vtksys
)
find_package(VTK 9.1 REQUIRED COMPONENTS ${BSPC_VTK_COMPONENTS})
# The interpreter that VTK's own Python modules are made for is the one beside VTK.
if(NOT Python3_EXECUTABLE)
  find_program(BSPC_PYTHON3_BESIDE_VTK python3 PATHS "${VTK_PREFIX_PATH}/bin" NO_DEFAULT_PATH)
  mark_as_advanced(BSPC_PYTHON3_BESIDE_VTK)
  if(BSPC_PYTHON3_BESIDE_VTK)
    set(Python3_EXECUTABLE "${BSPC_PYTHON3_BESIDE_VTK}")
  endif()
endif()
find_package(VTK 9.1 QUIET REQUIRED
  COMPONENTS ${BSPC_VTK_COMPONENTS}
  OPTIONAL_COMPONENTS Python WrappingPythonCore
)

set(BSPC_PYTHON_DEFAULT OFF)
if(TARGET VTK::WrappingPythonCore AND NOT BSPC_SANITIZE)
  set(BSPC_PYTHON_DEFAULT ON)
endif()
option(BSPC_BUILD_PYTHON "Build the Python package on the VTK modules" ${BSPC_PYTHON_DEFAULT})

# Modules are shared libraries whatever the library itself is.
set(BUILD_SHARED_LIBS ON)

add_subdirectory(vtk_support)
vtk_module_scan(
  MODULE_FILES ${BSPC_VTK_MODULE_FILES}
  REQUEST_MODULES BSPC::vtkBSPReader BSPC::vtkBSPWriter
  PROVIDES_MODULES bspc_vtk_modules
  ENABLE_TESTS OFF
)

function(bspc_build_vtk_modules)
  # Libraries find each other when they are installed, wherever that is.
  set(CMAKE_INSTALL_RPATH "$ORIGIN")
  vtk_module_build(
    MODULES ${bspc_vtk_modules}
    PACKAGE BSPC
    INSTALL_EXPORT BSPC
    INSTALL_HEADERS ON
    CMAKE_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/BSPC"
    HEADERS_DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/bspc-vtk"
    ENABLE_WRAPPING ON
    VERSION "${PROJECT_VERSION}"
    SOVERSION "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}"
  )
endfunction()
bspc_build_vtk_modules()

if(BSPC_BUILD_PYTHON)
  add_subdirectory(python)
endif()
