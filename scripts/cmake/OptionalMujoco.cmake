# MuJoCo, if it is installed (scripts/setup.sh bench): the target mujoco::mujoco. Only tests and benchmarks use it, and
# they are left out or check less without it.
find_package(mujoco QUIET)
if(mujoco_FOUND)
  # Debian's target names the folder of another package's headers, which MuJoCo's headers do not include.
  get_target_property(folders mujoco::mujoco INTERFACE_INCLUDE_DIRECTORIES)
  list(FILTER folders EXCLUDE REGEX qhull)
  set_target_properties(mujoco::mujoco PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${folders}")
endif()
