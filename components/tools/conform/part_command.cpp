// `constrictor conform control`, and those of the other members of a run.
#include <fmt/format.h>

#include "conform/command.hpp"
#include "conform/manifest_run.hpp"
#include "conform/observer_port.hpp"
#include "conform/parts.hpp"
#include "runtime/host.hpp"

namespace constrictor::conform {
namespace {

/// Watches the part in a run that goes on.
int observe(const Options& options, const PartKind& kind) {
  const PartSetting setting{load_robot(robot_file(options.robot)), options.profile, {}, false};
  note_signals();
  Report report(kind.checks(), [](const Check& check) { print_line(text_of(check)); });
  std::string gone;
  try {
    ObserverPort port(*options.domain, [] { return signal_number() != 0; });
    kind.run(port, setting, report);
  } catch (const PartGone& error) {
    gone = error.what();
  }
  return concluded(options, report, gone);
}

}  // namespace

int part_command(const Options& options, const std::string& part) {
  const PartKind& kind = part_kind(part);
  if (shown(options, kind.checks(), kind.profile(options.profile))) return exit_status::kOk;
  if (options.domain) return observe(options, kind);
  if (options.manifest.empty()) {
    fmt::print(stderr, "conform: found no --manifest, accepted one: the {} of this manifest is checked\n", part);
    return exit_status::kUsage;
  }
  const auto manifest = [](const Options& given, const std::string& name, const std::filesystem::path& folder) {
    return part_manifest(part_place(name), manifest_file(given.manifest), folder);
  };
  static_cast<void>(manifest(options, part, {}));  // a wrong manifest is refused before the user is asked
  if (kind.moves_joints && !options.yes && !agreed(kind.what)) return exit_status::kUsage;
  note_signals();
  return check_in_run(options, manifest, part);
}

}  // namespace constrictor::conform
