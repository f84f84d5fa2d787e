# Used by the examples on Fast DDS: finds it, and generates the types of Constrictor's IDL files.
find_package(fastcdr REQUIRED)
find_package(fastrtps REQUIRED)
find_program(FASTDDSGEN fastddsgen REQUIRED)
find_path(CONSTRICTOR_IDL constrictor/hardware.idl PATHS /usr/local/share/constrictor/idl /usr/share/constrictor/idl
          REQUIRED DOC "Folder of Constrictor's IDL files")

# fastdds_types(TARGET SUBJECT...): adds the types of constrictor/SUBJECT.idl to an executable, and Fast DDS.
function(fastdds_types target)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
  foreach(subject IN LISTS ARGN)
    list(APPEND idl ${CONSTRICTOR_IDL}/constrictor/${subject}.idl)
    list(APPEND sources ${generated}/${subject}.cxx ${generated}/${subject}PubSubTypes.cxx)
  endforeach()
  file(MAKE_DIRECTORY ${generated})
  add_custom_command(OUTPUT ${sources} DEPENDS ${idl} VERBATIM
    COMMAND ${FASTDDSGEN} -replace -cs -I ${CONSTRICTOR_IDL}/constrictor -d ${generated} ${idl}
            > ${generated}/fastddsgen.log)
  set_source_files_properties(${sources} PROPERTIES
    COMPILE_OPTIONS "-include;${CMAKE_CURRENT_FUNCTION_LIST_DIR}/generated_code.hpp;-w")
  target_sources(${target} PRIVATE ${sources})
  target_include_directories(${target} SYSTEM PRIVATE ${generated})
  target_link_libraries(${target} PRIVATE fastrtps fastcdr)
endfunction()
