# `cmake --install build/release --prefix PREFIX`: everything that is needed to run Constrictor and to build against it.
#   PREFIX/bin/constrictor                the command; a link into libexec
#   PREFIX/libexec/constrictor            every program of components/, sim/ and deploy/: their names are too common for bin
#   PREFIX/share/constrictor              configurations, robots, scenarios, manifests; idl/; examples/
#   PREFIX/include/constrictor, PREFIX/lib   messages, runtime, robot, configuration as libraries: find_package(Constrictor)
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

foreach(folder components sim deploy)
  executables_below(${PROJECT_SOURCE_DIR}/${folder} programs)
  install(TARGETS ${programs} RUNTIME DESTINATION ${LIBEXEC})
endforeach()
install(CODE "
  set(bin \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\")
  file(MAKE_DIRECTORY \"\${bin}\")
  file(CREATE_LINK ../${LIBEXEC}/constrictor \"\${bin}/constrictor\" SYMBOLIC)")

# File by file: install(DIRECTORY) would leave the empty folders of everything else.
file(GLOB_RECURSE DATA RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS
     components/*.yaml sim/*.yaml deploy/*.yaml deploy/*.xml deploy/README.md idl/*.idl idl/README.md)
foreach(file IN LISTS DATA)
  get_filename_component(folder ${file} DIRECTORY)
  install(FILES ${file} DESTINATION ${SHARE}/${folder})
endforeach()
install(DIRECTORY examples DESTINATION ${SHARE})
install(FILES LICENSE README.md DESTINATION ${SHARE})

# Libraries to build against, as Constrictor::messages and so on.
set(PUBLIC_LIBRARIES options messages component_api barrier runtime configuration robot)
foreach(library IN LISTS PUBLIC_LIBRARIES)
  set_target_properties(constrictor_${library} PROPERTIES EXPORT_NAME ${library})
  install(TARGETS constrictor_${library} EXPORT ConstrictorTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
endforeach()
file(GLOB_RECURSE DATA RELATIVE ${PROJECT_SOURCE_DIR}/components CONFIGURE_DEPENDS
     components/runtime/*.hpp components/configuration/*.hpp components/robot/*.hpp)
foreach(file IN LISTS DATA)
  get_filename_component(folder ${file} DIRECTORY)
  install(FILES components/${file} DESTINATION ${HEADERS}/${folder})
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/components/runtime/generated/runtime/version.hpp DESTINATION ${HEADERS}/runtime)
install(DIRECTORY idl/constrictor DESTINATION ${HEADERS} FILES_MATCHING PATTERN "*.hpp")
# idlc's C headers beside messages.hpp, which includes them by their bare names.
install(DIRECTORY ${PROJECT_BINARY_DIR}/idl/ DESTINATION ${HEADERS}/constrictor FILES_MATCHING PATTERN "*.h" PATTERN CMakeFiles EXCLUDE PATTERN generated EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/idl/generated/constrictor/messages.hpp DESTINATION ${HEADERS}/constrictor)

set(PACKAGE ${CMAKE_INSTALL_LIBDIR}/cmake/Constrictor)
install(EXPORT ConstrictorTargets NAMESPACE Constrictor:: DESTINATION ${PACKAGE})
configure_package_config_file(scripts/cmake/ConstrictorConfig.cmake.in ${PROJECT_BINARY_DIR}/ConstrictorConfig.cmake
                              INSTALL_DESTINATION ${PACKAGE} PATH_VARS SHARE LIBEXEC NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Messages may change from one minor version to the next: only the same one will do.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ConstrictorConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ConstrictorConfig.cmake ${PROJECT_BINARY_DIR}/ConstrictorConfigVersion.cmake DESTINATION ${PACKAGE})
