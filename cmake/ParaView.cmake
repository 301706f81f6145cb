# ParaView's VTK, looked for once: for the pictures (src/insitu) and for VTP files (src/network/vtp).
if(NOT RHEXIS_INSITU)
  return()
endif()

# The window of src/insitu replaces parts of VTK that changed in ParaView 5.13, which needs none of this.
find_package(ParaView 5.11...<5.13 QUIET COMPONENTS Catalyst PythonCatalyst)
if(NOT ParaView_FOUND)
  return()
endif()

# Debian's ParaView names private dependencies that it does not find; nothing of ours uses them.
foreach(target Freetype::Freetype X11::X11 GLEW::GLEW LibXml2::LibXml2 hdf5::hdf5 hdf5::hdf5_hl Boost::boost
               NetCDF::NetCDF)
  if(NOT TARGET ${target})
    add_library(${target} INTERFACE IMPORTED)
  endif()
endforeach()
