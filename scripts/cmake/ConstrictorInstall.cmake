# `cmake --install build/release --prefix PREFIX`: all that is needed to run Constrictor and to build against it.
#   PREFIX/bin/constrictor        the command; a link into libexec
#   PREFIX/libexec/constrictor    all programs of components/ and sim/: their names are too common for bin
#   PREFIX/share/constrictor      configurations, robots, scenarios, manifests, idl/, examples/
#   PREFIX/include/constrictor, PREFIX/lib   the libraries for find_package(Constrictor)
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
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
add_custom_target(programs DEPENDS ${PROGRAMS})  # what a run needs: no tests, no benchmarks
install(CODE "
  set(bin \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\")
  file(MAKE_DIRECTORY \"\${bin}\")
  file(CREATE_LINK ../${LIBEXEC}/constrictor \"\${bin}/constrictor\" SYMBOLIC)")

# Each file by itself, because install(DIRECTORY) also makes the folders from which no file is installed.
file(GLOB_RECURSE DATA RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
     components/*.yaml sim/*.yaml deploy/*.yaml deploy/*.xml deploy/README.md idl/*.idl idl/*.md)
foreach(file IN LISTS DATA)
  get_filename_component(folder ${file} DIRECTORY)
  install(FILES ${file} DESTINATION ${SHARE}/${folder})
endforeach()
install(DIRECTORY examples DESTINATION ${SHARE})
install(FILES LICENSE README.md DESTINATION ${SHARE})

# Libraries to build against, as Constrictor::messages and so on.
set(PUBLIC_LIBRARIES options messages log component barrier cyclone client runtime configuration robot)
foreach(library IN LISTS PUBLIC_LIBRARIES)
  set_target_properties(constrictor_${library} PROPERTIES EXPORT_NAME ${library})
  install(TARGETS constrictor_${library} EXPORT ConstrictorTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endforeach()
file(GLOB_RECURSE DATA RELATIVE ${PROJECT_SOURCE_DIR}/components/lib CONFIGURE_DEPENDS components/lib/*.hpp)
foreach(file IN LISTS DATA)
  get_filename_component(folder ${file} DIRECTORY)
  install(FILES components/lib/${file} DESTINATION ${HEADERS}/${folder})
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/components/lib/runtime/generated/runtime/version.hpp DESTINATION ${HEADERS}/runtime)
install(DIRECTORY idl/constrictor DESTINATION ${HEADERS} FILES_MATCHING PATTERN "*.hpp" PATTERN "*.def")
# The C headers made by idlc stand beside messages.hpp, which includes them by their names alone.
install(DIRECTORY ${PROJECT_BINARY_DIR}/idl/ DESTINATION ${HEADERS}/constrictor
        FILES_MATCHING PATTERN "*.h" PATTERN CMakeFiles EXCLUDE PATTERN generated EXCLUDE)
install(DIRECTORY ${PROJECT_BINARY_DIR}/idl/generated/constrictor/ DESTINATION ${HEADERS}/constrictor)

set(PACKAGE ${CMAKE_INSTALL_LIBDIR}/cmake/Constrictor)
install(EXPORT ConstrictorTargets NAMESPACE Constrictor:: DESTINATION ${PACKAGE})
configure_package_config_file(scripts/cmake/ConstrictorConfig.cmake.in ${PROJECT_BINARY_DIR}/ConstrictorConfig.cmake
                              INSTALL_DESTINATION ${PACKAGE} PATH_VARS SHARE LIBEXEC NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Messages may change from one minor version to the next: only the same minor version is compatible.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ConstrictorConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ConstrictorConfig.cmake ${PROJECT_BINARY_DIR}/ConstrictorConfigVersion.cmake
        DESTINATION ${PACKAGE})
