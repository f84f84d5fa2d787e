# `cmake --install build/release --prefix PREFIX`: all that is needed to run Constrictor and to build against it.
#   PREFIX/bin/constrictor        the command; a link into libexec
#   PREFIX/libexec/constrictor    all programs of components/ and sim/: their names are too common for bin
#   PREFIX/share/constrictor      configurations, robots, scenarios, manifests, idl/, examples/
#   PREFIX/etc/constrictor        files of this host; /etc/constrictor for the prefix /usr
#   PREFIX/lib/systemd, PREFIX/share/{bash-completion,zsh,fish}   the service, and the completion of the shells
#   PREFIX/share/man               the manual pages
#   PREFIX/lib/python3/dist-packages/constrictor   the Python package (component `python`)
#   PREFIX/include/constrictor, PREFIX/lib   the libraries for find_package(Constrictor)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME runtime)  # what a run needs; the component `dev` is for builds against it
set(LIBEXEC ${CMAKE_INSTALL_LIBEXECDIR}/constrictor)
set(SHARE ${CMAKE_INSTALL_DATADIR}/constrictor)
set(HEADERS ${CMAKE_INSTALL_INCLUDEDIR}/constrictor)

# Every executable below a folder of the build.
function(executables_below folder result)
  get_property(found DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  set(programs "")
  foreach(target IN LISTS found)
    get_target_property(type ${target} TYPE)
    if(type STREQUAL EXECUTABLE)
      list(APPEND programs ${target})
    endif()
  endforeach()
  get_property(children DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(child IN LISTS children)
    executables_below(${child} more)
    list(APPEND programs ${more})
  endforeach()
  set(${result} ${programs} PARENT_SCOPE)
endfunction()

set(PROGRAMS "")
foreach(folder components sim components/tools)
  executables_below(${PROJECT_SOURCE_DIR}/${folder} found)
  list(APPEND PROGRAMS ${found})
endforeach()
install(TARGETS ${PROGRAMS} RUNTIME DESTINATION ${LIBEXEC})
# Modules are loaded by programs that lie beside them.
install(TARGETS constrictor_figure_module constrictor_overview_module LIBRARY DESTINATION ${LIBEXEC})
# What is installed: no tests, no benchmarks.
add_custom_target(programs DEPENDS ${PROGRAMS} constrictor_figure_module constrictor_overview_module)
if(TARGET constrictor_python)
  add_dependencies(programs constrictor_python)
endif()
install(CODE "
  set(bin \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\")
  file(MAKE_DIRECTORY \"\${bin}\")
  file(CREATE_LINK ../${LIBEXEC}/constrictor \"\${bin}/constrictor\" SYMBOLIC)")

# Each file by itself, because install(DIRECTORY) also makes the folders from which no file is installed.
file(GLOB_RECURSE DATA RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
     components/*.yaml components/tools/dashboard/page/*
     sim/*.yaml deploy/*.yaml deploy/*.xml deploy/*.md idl/*.idl idl/*.md)
foreach(file IN LISTS DATA)
  get_filename_component(folder ${file} DIRECTORY)
  install(FILES ${file} DESTINATION ${SHARE}/${folder})
endforeach()
install(DIRECTORY examples DESTINATION ${SHARE} COMPONENT dev)
install(FILES LICENSE README.md DESTINATION ${SHARE})

# Files that belong to the host, the unit for systemd, and the completion of the shells.
install(CODE "
  set(etc \"\${CMAKE_INSTALL_PREFIX}/etc\")
  if(CMAKE_INSTALL_PREFIX STREQUAL /usr)
    set(etc /etc)
  endif()
  file(INSTALL DESTINATION \"\${etc}/constrictor\" TYPE FILE
       FILES ${PROJECT_SOURCE_DIR}/deploy/host/README ${PROJECT_SOURCE_DIR}/deploy/host/example.conf)")
install(FILES deploy/host/constrictor@.service DESTINATION lib/systemd/system)
set(COMPLETIONS "bash|bash-completion/completions|constrictor" "zsh|zsh/vendor-completions|_constrictor"
                "fish|fish/vendor_completions.d|constrictor.fish")
foreach(entry IN LISTS COMPLETIONS)
  string(REPLACE "|" ";" entry ${entry})
  list(GET entry 0 shell)
  list(GET entry 1 folder)
  list(GET entry 2 name)
  install(CODE "
    set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/${folder}\")
    file(MAKE_DIRECTORY \"\${folder}\")
    execute_process(COMMAND ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/constrictor completion ${shell}
                    OUTPUT_FILE \"\${folder}/${name}\" COMMAND_ERROR_IS_FATAL ANY)")
endforeach()

# The manual pages, from the help of the command that was built.
install(CODE "
  set(folder \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1\")
  file(GLOB old \"\${folder}/constrictor*.1.gz\")
  if(old)
    file(REMOVE \${old})
  endif()
  execute_process(COMMAND ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/constrictor man-pages \"\${folder}\"
                  COMMAND_ERROR_IS_FATAL ANY)
  file(GLOB pages \"\${folder}/constrictor*.1\")
  execute_process(COMMAND gzip -9nf \${pages} COMMAND_ERROR_IS_FATAL ANY)")

# Libraries to build against, as Constrictor::messages and so on.
set(PUBLIC_LIBRARIES options messages log component barrier device_faults faults cyclone recording client runtime
    configuration command_line robot dynamixel serial plant scheduling)
foreach(library IN LISTS PUBLIC_LIBRARIES)
  set_target_properties(constrictor_${library} PROPERTIES EXPORT_NAME ${library})
  install(TARGETS constrictor_${library} EXPORT ConstrictorTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
endforeach()
file(GLOB_RECURSE DATA RELATIVE ${PROJECT_SOURCE_DIR}/components/lib CONFIGURE_DEPENDS components/lib/*.hpp)
foreach(file IN LISTS DATA)
  get_filename_component(folder ${file} DIRECTORY)
  install(FILES components/lib/${file} DESTINATION ${HEADERS}/${folder} COMPONENT dev)
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/components/lib/runtime/generated/runtime/version.hpp DESTINATION ${HEADERS}/runtime
        COMPONENT dev)
install(DIRECTORY idl/constrictor DESTINATION ${HEADERS} COMPONENT dev FILES_MATCHING PATTERN "*.hpp" PATTERN "*.def")
# The C headers made by idlc stand beside messages.hpp, which includes them by their names alone.
install(DIRECTORY ${PROJECT_BINARY_DIR}/idl/ DESTINATION ${HEADERS}/constrictor COMPONENT dev
        FILES_MATCHING PATTERN "*.h" PATTERN CMakeFiles EXCLUDE PATTERN generated EXCLUDE)
install(DIRECTORY ${PROJECT_BINARY_DIR}/idl/generated/constrictor/ DESTINATION ${HEADERS}/constrictor
        COMPONENT dev)

set(PACKAGE ${CMAKE_INSTALL_LIBDIR}/cmake/Constrictor)
install(EXPORT ConstrictorTargets NAMESPACE Constrictor:: DESTINATION ${PACKAGE} COMPONENT dev)
configure_package_config_file(scripts/cmake/ConstrictorConfig.cmake.in ${PROJECT_BINARY_DIR}/ConstrictorConfig.cmake
                              INSTALL_DESTINATION ${PACKAGE} PATH_VARS SHARE LIBEXEC NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Messages may change from one minor version to the next: only the same minor version is compatible.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ConstrictorConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ConstrictorConfig.cmake ${PROJECT_BINARY_DIR}/ConstrictorConfigVersion.cmake
        DESTINATION ${PACKAGE} COMPONENT dev)
