# For the Python package: a small static OpenCV (core, imgproc, features2d, flann, calib3d). The first run builds it in the user's
# cache, from the source of scripts/helpers/opencv_contrib_source.py. Delete that folder to build a newer one.
execute_process(COMMAND "${CMAKE_COMMAND}" -E env --unset=PYTHONPATH  # which hides other packages in an isolated build
    "${Python_EXECUTABLE}" "${root}/scripts/helpers/opencv_contrib_source.py"
  OUTPUT_STRIP_TRAILING_WHITESPACE OUTPUT_VARIABLE source COMMAND_ERROR_IS_FATAL ANY)
file(TO_CMAKE_PATH "${source}/opencv" source)
get_filename_component(static_opencv "${source}/../../opencv-static-4" ABSOLUTE)
if(CMAKE_CROSSCOMPILING)
  string(APPEND static_opencv "-${CMAKE_SYSTEM_PROCESSOR}")
endif()

# step ARGUMENT...: runs CMake with its output in a file; prints the end of the file only if it fails.
function(step)
  execute_process(COMMAND "${CMAKE_COMMAND}" ${ARGV} RESULT_VARIABLE failed OUTPUT_VARIABLE log ERROR_VARIABLE log)
  if(failed)
    string(LENGTH "${log}" length)
    math(EXPR begin "${length} - 3000")
    if(begin GREATER 0)
      string(SUBSTRING "${log}" ${begin} -1 log)
    endif()
    message(FATAL_ERROR "${log}")
  endif()
endfunction()

file(LOCK "${static_opencv}.lock" GUARD FILE)
if(NOT EXISTS "${static_opencv}")
  set(work "${static_opencv}.build")  # stays if this is interrupted, so that the next call goes on from there
  message(STATUS "iib: building a static OpenCV in ${work} (once, about ten minutes)")
  # What CMake would look for on this machine, download, or build beside these modules.
  set(off IPP ITT OPENCL LAPACK EIGEN VA KLEIDICV PROTOBUF FLATBUFFERS ADE QUIRC OBSENSOR 1394 FFMPEG GSTREAMER V4L GTK WIN32UI
    MSMF DSHOW DIRECTX AVFOUNDATION JPEG PNG TIFF WEBP OPENJPEG JASPER OPENEXR AVIF)
  list(TRANSFORM off PREPEND WITH_)
  list(APPEND off BUILD_TESTS BUILD_PERF_TESTS BUILD_EXAMPLES BUILD_JAVA BUILD_opencv_apps BUILD_opencv_python3 BUILD_SHARED_LIBS
    BUILD_WITH_STATIC_CRT OPENCV_GENERATE_PKGCONFIG)
  list(TRANSFORM off PREPEND -D)
  list(TRANSFORM off APPEND =OFF)
  step(-S "${source}" -B "${work}" -G "${CMAKE_GENERATOR}" "-DCMAKE_MAKE_PROGRAM=${CMAKE_MAKE_PROGRAM}"
    "-DCMAKE_OSX_ARCHITECTURES=${CMAKE_OSX_ARCHITECTURES}" "-DCMAKE_OSX_DEPLOYMENT_TARGET=${CMAKE_OSX_DEPLOYMENT_TARGET}"
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_LIBDIR=lib -DOPENCV_LICENSES_INSTALL_PATH=licenses
    "-DBUILD_LIST=core,imgproc,features2d,flann,calib3d" -DENABLE_PIC=ON -DBUILD_ZLIB=ON ${off})
  cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
  step(--build "${work}" --config Release --parallel ${cores})
  step(--install "${work}" --config Release --prefix "${static_opencv}.new")
  file(COPY "${source}/LICENSE" "${source}/COPYRIGHT" DESTINATION "${static_opencv}.new/licenses")
  file(RENAME "${static_opencv}.new" "${static_opencv}")
  file(REMOVE_RECURSE "${work}")
endif()
file(LOCK "${static_opencv}.lock" RELEASE)

unset(OpenCV_DIR CACHE)  # of the system's
set(OpenCV_STATIC ON)
find_package(OpenCV REQUIRED PATHS "${static_opencv}" NO_DEFAULT_PATH)
unset(OpenCV_DIR CACHE)  # else the next run in this build folder would take it for the system's
install(DIRECTORY "${static_opencv}/licenses/" DESTINATION opencv_iib/licenses)
