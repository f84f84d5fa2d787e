# `cpack --config build/release/CPackConfig.cmake`: three Debian packages, below /usr.
#   constrictor       what a run needs
#   constrictor-dev   headers, libraries and examples for programs of one's own
#   python3-constrictor   the Python package
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR Constrictor)
set(CPACK_PACKAGE_CONTACT "The Constrictor developers <constrictor@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Framework for snake robots as components on Cyclone DDS")
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_SET_DESTDIR ON)  # for /etc, which is not below the prefix
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL runtime dev)
if(TARGET constrictor_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME constrictor)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/debian/conffiles)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS fonts-dejavu-core)  # of the figures; SHLIBDEPS adds the libraries
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS "tmux, openssh-client")
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION
    "Physics, camera, perception, guidance, navigation, control and planner of a snake robot
 that follows a line and carries objects with its body, each in a process of its own.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME constrictor-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "constrictor (= ${PROJECT_VERSION}), cyclonedds-dev, libcli11-dev, libeigen3-dev, \
libfmt-dev, libspdlog-dev, libssl-dev, libyaml-cpp-dev, libzstd-dev, nlohmann-json3-dev, zlib1g-dev")
set(CPACK_COMPONENT_DEV_DESCRIPTION
    "Headers, libraries, IDL files and examples for components, planners and clients
 of one's own: find_package(Constrictor).")

if(TARGET constrictor_python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-constrictor)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  # The module works with this version of Python only.
  get_property(version GLOBAL PROPERTY CONSTRICTOR_PYTHON_VERSION)
  list(GET version 0 major)
  list(GET version 1 minor)
  math(EXPR next "${minor} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "python3 (>= ${major}.${minor}), python3 (<< ${major}.${next}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "constrictor, python3-matplotlib")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
      "Joins runs of Constrictor from Python: topics as dictionaries and arrays, tasks,
 parameters, and the time of the run.")
endif()
include(CPack)
