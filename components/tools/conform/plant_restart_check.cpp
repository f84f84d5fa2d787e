// The plant's process is killed and started again.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "configuration/counted.hpp"

#include "conform/plant_conformance.hpp"

namespace constrictor::conform {
namespace {

constexpr double kWatchFirst_s = 1.0;  // for which the new process is watched before it gets a command
constexpr double kStopBound_s = 5.0;   // for clearing a stop

}  // namespace

void PlantConformance::check_restart(std::size_t joint) {
  // A process that went on with an old command would finish this motion. One that takes its start for that of the
  // robot would go back to the posture at the start of the checks.
  break_motion_off(joint);
  const std::vector<double> rest_rad = hand_.mean_rad(hand_.watch(5 * profile_.period_s));
  const std::uint64_t before = port_.incarnation();
  std::string fault;
  try {
    const std::string obstacle = port_.restart();
    if (!obstacle.empty()) {
      hand_.begin_at_posture();
      hand_.hold(profile_.settle_s);
      return report_.skip("restart", obstacle);
    }
    fault = restart_fault(rest_rad, before);
  } catch (const PlantGone& gone) {
    return report_.fail("restart", gone.what(), "go on with the run after a crash: a successor loads the checkpoint");
  }
  if (!fault.empty())
    return report_.fail("restart", fault,
                        "begin with the measured posture as the goal of each joint, in a session of a new random "
                        "number; obey nothing that was sent before");
  if (port_.stopped()) {  // the watchdogs of servos may have tripped meanwhile
    port_.clear_stop();
    for (const double begin_s = port_.now_s(); port_.stopped() && port_.now_s() - begin_s < kStopBound_s;)
      hand_.watch(profile_.period_s);
  }
  check_return(joint, "restart",
               "obey the session that continues: a new process has not yet received any number of it");
}

std::string PlantConformance::restart_fault(const std::vector<double>& rest_rad, std::uint64_t before) {
  const double begin_s = port_.now_s();
  std::vector<JointSample> samples;
  const auto watch = [&](double seconds) {
    const std::vector<JointSample> more = hand_.watch(seconds);
    samples.insert(samples.end(), more.begin(), more.end());
  };
  while (port_.incarnation() == before && port_.now_s() - begin_s < profile_.restart_within_s) watch(profile_.period_s);
  if (port_.incarnation() == before)
    return fmt::format("no other session within {:.0f} s after the process was ended", profile_.restart_within_s);
  watch(kWatchFirst_s);
  const double bound_rad = std::max(profile_.rest_rad, 0.3 * profile_.amplitude_rad);
  std::size_t farthest = 0;
  double strayed_rad = 0.0;
  for (const auto& sample : samples) {
    if (sample.position_rad.size() != rest_rad.size())
      return counted(sample.position_rad.size(), "joint") + " after the restart";
    for (std::size_t i = 0; i < rest_rad.size(); ++i) {
      const double far_rad = std::abs(sample.position_rad[i] - rest_rad[i]);
      if (std::isfinite(far_rad) && far_rad <= strayed_rad) continue;
      strayed_rad = std::isfinite(far_rad) ? far_rad : INFINITY;
      farthest = i;
    }
  }
  if (strayed_rad < bound_rad) return {};
  return fmt::format("joint {} moved by {:.3f} rad after the restart, without a command", farthest, strayed_rad);
}

}  // namespace constrictor::conform
