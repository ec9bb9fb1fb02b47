# Installs libraries, headers (beside OpenCV's own), the CMake package opencv_iib and opencv_iib.pc.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(include_dir "${CMAKE_INSTALL_INCLUDEDIR}/opencv4")
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/opencv_iib")

add_custom_target(iib_installed)  # everything that `cmake --install` needs

# The library opencv_NAME and the headers of a folder.
function(iib_install_library name dir)
  set(target opencv_${name})
  target_include_directories(${target} INTERFACE "$<INSTALL_INTERFACE:${include_dir}>")
  # Outside of the system's folders, a library finds the others in its own folder.
  if(UNIX AND NOT APPLE AND NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND NOT name STREQUAL "iib")
    set_target_properties(${target} PROPERTIES INSTALL_RPATH "\$ORIGIN")
  endif()
  add_dependencies(iib_installed ${target})
  install(TARGETS ${target} EXPORT opencv_iib LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}")
  install(DIRECTORY "${dir}/include/opencv2" DESTINATION "${include_dir}")
endfunction()
iib_install_library(iib "${IIB_DIR}")
iib_install_library(iib_index "${IIB_INDEX_DIR}")
set(pc_libraries "-lopencv_iib_index -lopencv_iib")
if(TARGET opencv_iib_geometry)
  iib_install_library(iib_geometry "${IIB_GEOMETRY_DIR}")
  set(pc_libraries "-lopencv_iib_geometry ${pc_libraries}")
endif()
install(EXPORT opencv_iib FILE opencv_iibTargets.cmake DESTINATION "${package_dir}")

configure_package_config_file(cmake/opencv_iibConfig.cmake.in opencv_iibConfig.cmake
  INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file(opencv_iibConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/opencv_iibConfig.cmake" "${PROJECT_BINARY_DIR}/opencv_iibConfigVersion.cmake"
  DESTINATION "${package_dir}")

# Programs linked by pkg-config find the library in the prefix, unless that is the system's.
set(pc_rpath "-Wl,-rpath,\${libdir} ")
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(pc_rpath "")
endif()
math(EXPR next_minor "${OpenCV_VERSION_MINOR} + 1")
# The prefix follows from the file's own path, so that `cmake --install --prefix` may choose it.
set(pc_dir "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
file(RELATIVE_PATH pc_to_prefix "/prefix/${pc_dir}" "/prefix")
configure_file(cmake/opencv_iib.pc.in opencv_iib.pc @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/opencv_iib.pc" DESTINATION "${pc_dir}")
