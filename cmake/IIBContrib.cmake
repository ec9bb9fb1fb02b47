# Target iib_contrib: the descriptors of opencv_contrib's xfeatures2d, which no Debian package has. The source is that of
# scripts/helpers/opencv_contrib_source.py, built against the installed OpenCV. Leaves out OpenCL, and BoostDesc and VGG, whose
# tables OpenCV's own build would download. SURF, which is not free, is an option.
set(xfeatures2d "${IIB_CONTRIB_SOURCE}/opencv_contrib/modules/xfeatures2d")
if(NOT EXISTS "${xfeatures2d}/src/beblid.cpp")
  message(FATAL_ERROR "IIB_CONTRIB_SOURCE is to be the folder that scripts/helpers/opencv_contrib_source.py prints, "
    "not \"${IIB_CONTRIB_SOURCE}\"")
endif()
# Stubs of headers that OpenCV's own build generates: empty ones switch optional features off.
set(stubs "${CMAKE_CURRENT_BINARY_DIR}/contrib_stubs")
foreach(stub cvconfig.h cv_cpu_config.h custom_hal.hpp)
  file(WRITE "${stubs}/${stub}" "")
endforeach()

find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc features2d)
add_library(iib_contrib STATIC)
foreach(name beblid brief daisy freak latch)
  target_sources(iib_contrib PRIVATE "${xfeatures2d}/src/${name}.cpp")
endforeach()
if(IIB_CONTRIB_NONFREE)
  target_sources(iib_contrib PRIVATE "${xfeatures2d}/src/surf.cpp")
  target_compile_definitions(iib_contrib PRIVATE OPENCV_ENABLE_NONFREE INTERFACE IIB_WITH_SURF)
endif()
target_compile_definitions(iib_contrib PRIVATE __OPENCV_BUILD=1 INTERFACE IIB_WITH_CONTRIB)
target_compile_options(iib_contrib PRIVATE -w)  # not ours to mend
# The installed headers come first: of the source tree's core only the private ones are wanted.
target_include_directories(iib_contrib SYSTEM PUBLIC "${xfeatures2d}/include"
  PRIVATE ${OpenCV_INCLUDE_DIRS} "${stubs}" "${IIB_CONTRIB_SOURCE}/opencv/modules/core/include")
target_link_libraries(iib_contrib PUBLIC opencv_core opencv_imgproc opencv_features2d)
