# find_package(ParaView) for building a plugin, also with Debian's packages.
#
# Debian splits ParaView: what paraview-dev installs names files of python3-paraview, which cannot be
# installed beside python3-vtk9 (and so not beside libvtk9-dev). A plugin needs none of them, but
#   - the package files include the targets of the Python libraries and stop where one is missing,
#   - the wrapping of classes reads hierarchy files, and without them it silently makes empty
#     wrappers, which end ParaView as soon as the plugin is used.
# So copies of the two package files are used that leave the Python parts out, and the hierarchy
# files of libvtk9.1 stand in for those that are missing: they say which classes derive from which,
# which is the same in both.

# Copies a package file to `to`, its own folder resolved, without the lines that include `without`.
function(bspc_copy_package_file from to)
  get_filename_component(folder "${from}" DIRECTORY)
  file(READ "${from}" text)
  string(REPLACE "\${CMAKE_CURRENT_LIST_DIR}" "${folder}" text "${text}")
  foreach(name IN LISTS ARGN)
    string(REPLACE "include(\"${folder}/${name}\" OPTIONAL)" "" text "${text}")
    string(REPLACE "include(\"${folder}/${name}\")" "" text "${text}")
  endforeach()
  file(WRITE "${to}" "${text}")
endfunction()

# Sets ParaView_DIR to package files that can be used; leaves it alone where it is set already.
function(bspc_locate_paraview)
  if(ParaView_DIR)
    return()
  endif()
  find_file(BSPC_PARAVIEW_CONFIG NAMES paraview-config.cmake
    PATH_SUFFIXES lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/paraview-5.11
                  lib/cmake/paraview-5.11
                  cmake/paraview-5.11
  )
  if(NOT BSPC_PARAVIEW_CONFIG)
    message(FATAL_ERROR "ParaView 5.11 with its development files was not found. On Debian, "
      "scripts/setup.sh --paraview installs it; elsewhere, set ParaView_DIR to the folder of "
      "paraview-config.cmake.")
  endif()
  get_filename_component(folder "${BSPC_PARAVIEW_CONFIG}" DIRECTORY)
  set(copy "${CMAKE_BINARY_DIR}/paraview-package")
  bspc_copy_package_file("${folder}/paraview-config.cmake" "${copy}/paraview-config.cmake"
    ParaViewPython-targets.cmake ParaViewTools-targets.cmake
    paraview.modules-vtk-python-module-properties.cmake
  )
  file(READ "${copy}/paraview-config.cmake" text)
  string(REPLACE "PATHS \"${folder}/vtk\"" "PATHS \"${copy}/vtk\"" text "${text}")
  file(WRITE "${copy}/paraview-config.cmake" "${text}")
  file(COPY "${folder}/paraview-config-version.cmake" DESTINATION "${copy}")
  bspc_copy_package_file("${folder}/vtk/vtk-config.cmake" "${copy}/vtk/vtk-config.cmake"
    VTKPython-targets.cmake vtkmodules-vtk-python-module-properties.cmake
  )
  set(ParaView_DIR "${copy}" CACHE PATH "Folder of paraview-config.cmake" FORCE)
endfunction()

# Where the hierarchy file of a module is missing, that of the same module of VTK itself is used.
# Modules that VTK's packages do not have keep none; bspc_require_hierarchies tells if one is needed.
function(bspc_repair_hierarchies)
  foreach(component IN LISTS ARGN)
    set(target "VTK::${component}")
    if(NOT TARGET ${target})
      continue()
    endif()
    get_property(file TARGET ${target} PROPERTY INTERFACE_vtk_module_hierarchy)
    if(NOT file OR EXISTS "${file}")
      continue()
    endif()
    find_file(stand_in NAMES vtk${component}-hierarchy.txt NO_CACHE
      PATH_SUFFIXES lib/${CMAKE_LIBRARY_ARCHITECTURE}/vtk/hierarchy/VTK lib/vtk/hierarchy/VTK
      HINTS /usr
    )
    if(stand_in)
      set_property(TARGET ${target} PROPERTY INTERFACE_vtk_module_hierarchy "${stand_in}")
    endif()
    unset(stand_in)
  endforeach()
endfunction()

# Stops where one of these modules has no hierarchy file: a plugin that wraps classes derived from
# theirs would build and then end ParaView.
function(bspc_require_hierarchies)
  foreach(component IN LISTS ARGN)
    get_property(file TARGET VTK::${component} PROPERTY INTERFACE_vtk_module_hierarchy)
    if(NOT EXISTS "${file}")
      message(FATAL_ERROR "The wrapping hierarchy ${file} is missing; on Debian, "
        "scripts/setup.sh --paraview installs one that can stand in for it.")
    endif()
  endforeach()
endfunction()

macro(bspc_find_paraview)
  bspc_locate_paraview()
  find_package(ParaView 5.11 REQUIRED
    COMPONENTS RemotingCore RemotingClientServerStream ProcessXML WrapClientServer
  )
  bspc_repair_hierarchies(${VTK_AVAILABLE_COMPONENTS})
  bspc_require_hierarchies(CommonCore CommonDataModel CommonExecutionModel IOCore ParallelCore)
endmacro()
