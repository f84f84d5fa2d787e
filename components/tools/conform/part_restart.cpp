#include "conform/part_restart.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace constrictor::conform {
namespace {

const char* const kTodo =
    "save() returns everything that the next steps depend on, and load() restores it; read nothing else at the start";

void judge_restart(Report& report, PartPort& port, const Repeat& repeat, const std::string& equal) {
  std::uint32_t before = 0;  // incarnation
  std::string obstacle, differs;
  try {
    differs = repeat([&] {
      before = port.incarnation();
      if (before == 1) obstacle = port.restart();
    });
    for (int i = 0; i < PartPort::kStatusTicks; ++i) port.advance();  // until the new process has reported itself
  } catch (const PartGone& gone) {
    return report.fail("restart", gone.what(), "end the process only when the run ends");
  }
  // A process that the launcher has started again without being asked for has crashed.
  if (before > 1)
    return report.fail("restart", fmt::format("the process has ended by itself, and is now incarnation {}", before),
                       "the log of the run says why it has ended");
  if (!obstacle.empty()) return report.skip("restart", obstacle);
  if (const std::uint32_t now = port.incarnation(); now != before + 1)
    return report.fail("restart", fmt::format("incarnation {} after the restart of incarnation {}", now, before),
                       kTodo);
  report.judge("restart", !differs.empty(), differs.empty() ? equal : "after a restart: " + differs, kTodo);
}

}  // namespace

Check restart_check() {
  return {"restart", "a process that is killed comes back, and goes on as if it had not been killed", {}, {}, {}};
}

void judge_repetitions(Report& report, PartPort& port, const std::string& differs, const Repeat& repeat,
                       const std::string& equal, const std::string& todo) {
  report.pass_unless("repeatable", differs, equal, todo);
  judge_restart(report, port, repeat, equal);
}

}  // namespace constrictor::conform
