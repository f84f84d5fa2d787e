# The groups of programs. The core is what `constrictor run` needs for the case study, and is always built. Every other
# group has an option here, an option of scripts/build.sh, and its packages in scripts/setup.sh, all of the same name.
# The command `constrictor` knows this table: it names the group of a program that was not built.
option(CONSTRICTOR_HARDWARE "Build the drivers of servos and cameras, emulated devices, and `constrictor conform`" OFF)
option(CONSTRICTOR_WEB "Build `constrictor dashboard`, which shows runs in a web browser" OFF)
option(CONSTRICTOR_PICTURES "Build `constrictor figure` and `constrictor film`" OFF)
option(CONSTRICTOR_ROS "Build `ros_bridge`, which connects runs with ROS 2" OFF)
option(CONSTRICTOR_PYTHON "Build the Python package" OFF)

set(CONSTRICTOR_GROUPS hardware web pictures ros python)
set(CONSTRICTOR_PROGRAMS_hardware servo_bus plant_relay video_capture camera_setup servo_emulator camera_emulator
    conform conform_control conform_part)
set(CONSTRICTOR_PROGRAMS_web dashboard)
set(CONSTRICTOR_PROGRAMS_pictures pictures)
set(CONSTRICTOR_PROGRAMS_ros ros_bridge)
set(CONSTRICTOR_PROGRAMS_python "")

# Tests start and link the programs of all groups.
if(CONSTRICTOR_TESTS)
  foreach(group IN LISTS CONSTRICTOR_GROUPS)
    string(TOUPPER ${group} option)
    set(CONSTRICTOR_${option} ON)
  endforeach()
endif()

# Stops the configuration if a group that is switched on lacks one of its programs, or the other way round.
function(constrictor_check_groups)
  foreach(group IN LISTS CONSTRICTOR_GROUPS)
    string(TOUPPER ${group} option)
    foreach(program IN LISTS CONSTRICTOR_PROGRAMS_${group})
      if(CONSTRICTOR_${option} AND NOT TARGET ${program})
        message(FATAL_ERROR "ProgramGroups.cmake: the group ${group} has no program ${program}")
      elseif(NOT CONSTRICTOR_${option} AND TARGET ${program})
        message(FATAL_ERROR "ProgramGroups.cmake: ${program} is built without its group ${group}")
      endif()
    endforeach()
  endforeach()
endfunction()
