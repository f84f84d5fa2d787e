# Imported targets for the modules of OpenCV that are used, made from the packages libopencv-MODULE-dev.
# find_package(OpenCV) is not used because Debian ships its configuration files in libopencv-dev only, which needs the
# packages of all modules (471 packages). A group of programs asks only for the modules that it links: imgcodecs needs
# GDAL, videoio needs FFmpeg and GStreamer (240 libraries in all), and the headers of calib3d need Qt.
find_path(CONSTRICTOR_OPENCV_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4)
mark_as_advanced(CONSTRICTOR_OPENCV_INCLUDE)

# constrictor_opencv_module(NAME): the imported target opencv_NAME.
function(constrictor_opencv_module name)
  find_library(CONSTRICTOR_OPENCV_${name} opencv_${name})
  mark_as_advanced(CONSTRICTOR_OPENCV_${name})
  if(NOT CONSTRICTOR_OPENCV_INCLUDE OR NOT CONSTRICTOR_OPENCV_${name})
    message(FATAL_ERROR "OpenCV's module ${name} was not found: install libopencv-${name}-dev (scripts/setup.sh all)")
  endif()
  add_library(opencv_${name} SHARED IMPORTED GLOBAL)
  set_target_properties(opencv_${name} PROPERTIES
    IMPORTED_LOCATION ${CONSTRICTOR_OPENCV_${name}}
    INTERFACE_INCLUDE_DIRECTORIES ${CONSTRICTOR_OPENCV_INCLUDE}
    INTERFACE_LINK_LIBRARIES "${ARGN}")
endfunction()

constrictor_opencv_module(core)
constrictor_opencv_module(imgproc opencv_core)
if(CONSTRICTOR_HARDWARE OR CONSTRICTOR_PICTURES)
  constrictor_opencv_module(videoio opencv_core opencv_imgproc)
endif()
if(CONSTRICTOR_HARDWARE)
  constrictor_opencv_module(imgcodecs opencv_core opencv_imgproc)
  constrictor_opencv_module(calib3d opencv_core opencv_imgproc)
endif()
