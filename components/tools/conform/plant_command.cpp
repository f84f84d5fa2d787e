// `constrictor conform plant`.
#include <fmt/format.h>

#include "conform/command.hpp"
#include "conform/hardware_port.hpp"
#include "conform/manifest_run.hpp"
#include "conform/plant_conformance.hpp"
#include "runtime/host.hpp"

namespace constrictor::conform {

int plant_command(const Options& options) {
  const RobotModel robot = load_robot(robot_file(options.robot));
  PlantProfile profile = load_parameters<PlantProfile>(options.profile);
  profile.adapt_to(robot);
  if (shown(options, plant_checks(), profile.describe())) return exit_status::kOk;
  const std::string warning = fmt::format(
      "This moves {} joints, one after the other, by {:.2f} rad at {:.2f} rad/s, sends commands that must be ignored, "
      "and\nrelaxes the joints for a second. Lay the robot on flat ground and keep a hand at the power switch.",
      profile.joints.size(), profile.amplitude_rad, profile.rate_rad_s);
  if (!options.yes && !agreed(warning)) return exit_status::kUsage;
  note_signals();
  if (!options.manifest.empty()) {
    const auto manifest = [](const Options& given, const std::string&, const std::filesystem::path& folder) {
      return plant_manifest(manifest_file(given.manifest), folder);
    };
    return check_in_run(options, manifest, "plant");
  }
  Report report(plant_checks(), [](const Check& check) { print_line(text_of(check)); });
  std::string gone;
  try {
    HardwarePort port(options.domain, profile.period_s, options.robot_id, [] { return signal_number() != 0; });
    port.advance({});
    if (port.commanded_by_others()) {
      fmt::print(stderr,
                 "conform: found another process that writes hardware/joint_command in domain {} (plant_relay?); end "
                 "its run first\n",
                 options.domain);
      return exit_status::kUsage;
    }
    PlantConformance(port, robot, profile, report).run();
  } catch (const Interrupted&) {
    gone = "interrupted; the joints hold";
  } catch (const PlantGone& error) {
    gone = error.what();
  }
  return concluded(options, report, gone);
}

}  // namespace constrictor::conform
