#include "plant/real_time.hpp"

#include <fmt/format.h>
#include <sched.h>

#include <cerrno>
#include <cstring>

namespace constrictor {

std::string prefer_this_process(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (::sched_setscheduler(0, SCHED_FIFO, &parameters) == 0) return {};
  return fmt::format(
      "the real-time scheduler is not allowed ({}); `setcap cap_sys_nice+ep` on this program, or an rtprio limit in "
      "/etc/security/limits.conf, allows it",
      ::strerrordesc_np(errno));
}

}  // namespace constrictor
