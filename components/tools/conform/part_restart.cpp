#include "conform/part_restart.hpp"

#include <fmt/format.h>

namespace constrictor::conform {
namespace {

const char* const kTodo =
    "save() returns everything that the next steps depend on, and load() restores it; read nothing else at the start";

}  // namespace

Check restart_check() {
  return {"restart", "a process that is killed comes back, and goes on as if it had not been killed", {}, {}, {}};
}

void PartRestart::kill() {
  before_ = port_.incarnation();
  if (before_ == 1) obstacle_ = port_.restart();
}

void PartRestart::judge(Report& report, const std::function<std::string()>& play, const std::string& equal) {
  std::string differs;
  try {
    differs = play();
    for (int i = 0; i < PartPort::kStatusTicks; ++i) port_.advance();  // until the new process has reported itself
  } catch (const PartGone& gone) {
    return report.fail("restart", gone.what(), "end the process only when the run ends");
  }
  // A process that the launcher has started again without being asked for has crashed.
  if (before_ > 1)
    return report.fail("restart", fmt::format("the process has ended by itself, and is now incarnation {}", before_),
                       "the log of the run says why it has ended");
  if (!obstacle_.empty()) return report.skip("restart", obstacle_);
  if (const std::uint32_t now = port_.incarnation(); now != before_ + 1)
    return report.fail("restart", fmt::format("incarnation {} after the restart of incarnation {}", now, before_),
                       kTodo);
  report.judge("restart", !differs.empty(), differs.empty() ? equal : "after a restart: " + differs, kTodo);
}

}  // namespace constrictor::conform
