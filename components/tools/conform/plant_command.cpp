// `constrictor conform plant`.
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <cstring>

#include "conform/command.hpp"
#include "conform/hardware_port.hpp"
#include "conform/manifest_run.hpp"
#include "conform/plant_conformance.hpp"
#include "runtime/host.hpp"

namespace constrictor::conform {
namespace {

/// Starts the command, and does not wait for it: it may be the plant itself. Returns why not.
std::string run_in_background(const std::string& command) {
  std::string shell = "/bin/sh", option = "-c", text = command;
  char* const arguments[] = {shell.data(), option.data(), text.data(), nullptr};
  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_adddup2(&files, STDERR_FILENO, STDOUT_FILENO);
  posix_spawnattr_t attributes;  // a process group of its own: Ctrl-C does not reach the plant
  ::posix_spawnattr_init(&attributes);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  pid_t pid = -1;
  const int error = ::posix_spawn(&pid, shell.c_str(), &files, &attributes, arguments, environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  return error == 0 ? std::string() : fmt::format("--restart-command: {}", ::strerrordesc_np(error));
}

/// Restarts a plant outside the run, or asks the user to do so. Returns why not.
std::string restart_plant(const Options& options, double within_s) {
  if (!options.restart_command.empty()) return run_in_background(options.restart_command);
  if (options.yes || !::isatty(STDIN_FILENO))
    return "found no --restart-command, accepted one that ends the process and starts it again";
  print_line(fmt::format("End the plant's process and start it again now, within {:.0f} s.", within_s));
  return {};
}

}  // namespace

int plant_command(const Options& options) {
  const RobotModel robot = load_robot(robot_file(options.robot));
  PlantProfile profile = load_parameters<PlantProfile>(options.profile);
  profile.adapt_to(robot);
  if (shown(options, plant_checks(), profile.describe())) return exit_status::kOk;
  if (!options.domain && options.manifest.empty()) {
    fmt::print(stderr,
               "conform: found no --domain and no --manifest, accepted one of them: the plant in this DDS domain, or "
               "that of this manifest, is checked\n");
    return exit_status::kUsage;
  }
  const auto manifest = [&](const std::filesystem::path& folder) {
    return plant_manifest(manifest_file(options.manifest), folder);
  };
  // A wrong manifest is refused before the user is asked.
  if (!options.domain) static_cast<void>(manifest({}));
  const std::string warning = fmt::format(
      "This moves {} joints, one after the other, by {:.2f} rad at {:.2f} rad/s, sends commands that must be ignored, "
      "and\nrelaxes the joints for a second. Lay the robot on flat ground and keep a hand at the power switch.",
      profile.joints.size(), profile.amplitude_rad, profile.rate_rad_s);
  if (!options.yes && !agreed(warning)) return exit_status::kUsage;
  note_signals();
  if (!options.domain) {
    return check_in_run(options, [&](const std::filesystem::path& folder) {
      return run_manifest(
          manifest(folder), folder, [] { return signal_number() != 0; }, print_line);
    });
  }
  Report report(plant_checks(), [](const Check& check) { print_line(text_of(check)); });
  std::string gone;
  try {
    HardwarePort port(
        *options.domain, profile.period_s, options.robot_id, [] { return signal_number() != 0; },
        [&] { return restart_plant(options, profile.restart_within_s); });
    port.advance({});
    if (port.commanded_by_others()) {
      fmt::print(stderr,
                 "conform: found another process that writes hardware/joint_command in domain {} (plant_relay?); end "
                 "its run first\n",
                 *options.domain);
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
