# Which folders may use which: a table, and the check of all targets.

# The folders whose headers the targets of a folder may include, besides those of the folder itself: because they link
# the library, or because a library that they link passes it on. A row is a regular expression for the folder and one
# for the folders that it may use; the first row that fits counts.
set(CONSTRICTOR_LAYERS
  "idl.* => idl.*"
  "components/lib/configuration => none"
  "components/lib/log => idl"
  "components/lib/scheduling => none"
  "components/lib/dynamixel => components/lib/configuration"
  "components/lib/robot => idl|components/lib/configuration"
  "components/lib/video => idl|components/lib/(configuration|robot)"
  "components/lib/component => idl|components/lib/(configuration|log)"
  "components/lib/plant => idl|components/lib/(component|configuration|log|robot)"
  "components/lib/serial => components/lib/(configuration|dynamixel)"
  "components/lib/barrier => idl|components/lib/(component|configuration|log)"
  "components/lib/device_faults => none"
  "components/lib/faults => idl|components/lib/(component|barrier|configuration|device_faults|log)"
  "components/lib/cyclone => idl|components/lib/configuration"
  "components/lib/recording => idl"
  "components/lib/client => idl|components/lib/(component|configuration|cyclone|log)"
  "components/lib/runtime => idl|components/lib/(barrier|comp.*|configuration|cyclone|.*faults|log|recording|sched.*)"
  "components/tools/host => .*"
  "components/tools/pictures => idl|components/([a-z_]+|lib/.*|tools/common|tools/host)|sim/.*"
  "components/tools/views => idl|components/lib/(configuration|recording|robot)"
  "components/tools/cli => idl|components/lib/.*|components/tools/(common|views)|sim/scenario_loader"
  "components/tools/dashboard => idl|components/lib/.*|components/tools/(common|views)"
  "components/tools/.* => idl|components/lib/.*"
  "components/servo_bus => idl|components/lib/(component|configuration|dynamixel|log|plant|robot|serial)"
  "components/plant_relay => idl|components/lib/(component|configuration|log|plant|robot)"
  "components/video_capture => idl|components/lib/(component|configuration|log|robot|video)"
  "components/.* => idl|components/lib/(component|configuration|log|robot)"
  "sim/emulation => idl|components/lib/(component|configuration|log|robot)|sim/.*"
  "sim/.* => idl|components/lib/(component|configuration|device_faults|dynamixel|log|plant|robot)|sim/.*")

# What a program may link besides: the libraries by which it takes part in a run, and by which it logs.
set(CONSTRICTOR_PROGRAM_LAYER "components/lib/(cyclone|log|runtime|scheduling)")

# constrictor_included_libraries(RESULT TARGET): the libraries whose headers the files of the target can include: those
# that it links, and those that these pass on. What a program gets through the libraries of CONSTRICTOR_PROGRAM_LAYER is
# left out.
function(constrictor_included_libraries result target)
  get_target_property(waiting ${target} LINK_LIBRARIES)
  get_target_property(type ${target} TYPE)
  set(libraries "")
  while(waiting)
    list(POP_FRONT waiting library)
    if(NOT TARGET ${library} OR library IN_LIST libraries)
      continue()
    endif()
    list(APPEND libraries ${library})
    get_target_property(folder ${library} CONSTRICTOR_FOLDER)
    if(type STREQUAL EXECUTABLE AND folder MATCHES "^(${CONSTRICTOR_PROGRAM_LAYER})$")
      continue()
    endif()
    get_target_property(passed_on ${library} INTERFACE_LINK_LIBRARIES)
    if(passed_on)
      list(APPEND waiting ${passed_on})
    endif()
  endwhile()
  set(${result} "${libraries}" PARENT_SCOPE)
endfunction()

# constrictor_check_layers(FOLDER...): the configuration fails if a target of these folders, or of folders below them,
# can include headers of a library that its folder must not know. Called when all targets are known.
function(constrictor_check_layers)
  foreach(folder IN LISTS ARGN)
    foreach(row IN LISTS CONSTRICTOR_LAYERS)
      string(REGEX MATCH "^(.*) => (.*)$" row "${row}")
      set(libraries_may "${CMAKE_MATCH_2}")
      if(folder MATCHES "^(${CMAKE_MATCH_1})$")
        break()
      endif()
      set(libraries_may none)
    endforeach()
    get_property(targets DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target IN LISTS targets)
      get_target_property(type ${target} TYPE)
      set(allowed "${libraries_may}")
      if(type STREQUAL EXECUTABLE)
        string(APPEND allowed "|${CONSTRICTOR_PROGRAM_LAYER}")
      endif()
      constrictor_included_libraries(included ${target})
      foreach(library IN LISTS included)
        get_target_property(other ${library} CONSTRICTOR_FOLDER)
        if(other AND NOT other STREQUAL folder AND NOT other MATCHES "^(${allowed})$")
          message(SEND_ERROR "${folder}: ${target} can include ${library} of ${other}; accepted: ${allowed}")
        endif()
      endforeach()
    endforeach()
    get_property(children DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} PROPERTY SUBDIRECTORIES)
    foreach(child IN LISTS children)
      file(RELATIVE_PATH child ${PROJECT_SOURCE_DIR} ${child})
      constrictor_check_layers(${child})
    endforeach()
  endforeach()
endfunction()
