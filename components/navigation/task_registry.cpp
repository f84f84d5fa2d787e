// The tasks of navigation. A new task is a file in tasks/ and a row here.
#include <array>

#include "navigation/task.hpp"

// TASK(constant of task.idl, function that makes the task)
#define CONSTRICTOR_TASKS(TASK)               \
  TASK(kTaskFollowLine, make_follow_line)     \
  TASK(kTaskSearchObject, make_search_object) \
  TASK(kTaskTrackObject, make_track_object)   \
  TASK(kTaskPregrasp, make_pregrasp)          \
  TASK(kTaskGrasp, make_grasp)                \
  TASK(kTaskDrop, make_drop)                  \
  TASK(kTaskRotate, make_rotate)              \
  TASK(kTaskExplore, make_explore)            \
  TASK(kTaskFollowPath, make_follow_path)

namespace constrictor {

#define CONSTRICTOR_DECLARE_TASK(constant, make) std::unique_ptr<Task> make();
CONSTRICTOR_TASKS(CONSTRICTOR_DECLARE_TASK)

std::unique_ptr<Task> make_task(std::uint8_t task) {
  switch (task) {
#define CONSTRICTOR_MAKE_TASK(constant, make) \
  case msg::constant:                         \
    return make();
    CONSTRICTOR_TASKS(CONSTRICTOR_MAKE_TASK)
    default:
      return nullptr;
  }
}

}  // namespace constrictor
