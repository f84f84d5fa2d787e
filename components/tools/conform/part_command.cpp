// `constrictor conform control`, and those of the other members of a run.
#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "conform/command.hpp"
#include "conform/manifest_run.hpp"
#include "conform/observer_port.hpp"
#include "conform/parts.hpp"
#include "constrictor/messages.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
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

/// Whether a run goes on in the domain: whether a process writes ticks there.
bool run_goes_on(std::uint32_t domain) {
  constexpr int kMost = 20;  // times 50 ms, for the discovery
  const dds::Domain joined(domain);
  const auto ticks = dds::Reader<msg::Tick>::observer(joined.participant(), barrier_topics::kTick.name);
  for (int i = 0; i < kMost && signal_number() == 0; ++i) {
    if (ticks.writers() > 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

/// Serves a part that a user starts in a domain: only the members around it are started here.
int serve(const Options& options, const std::string& part) {
  const ServedPart served{part_place(part), *options.domain, robot_file(options.robot), scenario_file(options.scenario),
                          options.patience_s};
  const std::string arguments = fmt::format("{}", fmt::join(joining_arguments(served), " "));
  note_signals();
  if (run_goes_on(*options.domain)) {
    fmt::print(stderr, "conform: found a run in domain {}, accepted a domain without one; end the run first\n",
               *options.domain);
    return exit_status::kUsage;
  }
  print_line(fmt::format("Start the {} within {:.0f} s, if it does not run yet, with these arguments:\n  {}", part,
                         served.patience_s, arguments));
  return check_in_run(options, [&](const std::filesystem::path& folder) {
    return serve_part(
        served, folder, [] { return signal_number() != 0; }, print_line);
  });
}

}  // namespace

int part_command(const Options& options, const std::string& part) {
  const PartKind& kind = part_kind(part);
  if (shown(options, kind.checks(), kind.profile(options.profile))) return exit_status::kOk;
  if (options.domain) return kind.observable ? observe(options, kind) : serve(options, part);
  if (options.manifest.empty()) {
    fmt::print(stderr,
               "conform: found no --domain and no --manifest, accepted one of them: the {} in this "
               "domain, or that of this manifest, is checked\n",
               part);
    return exit_status::kUsage;
  }
  const auto manifest = [&](const std::filesystem::path& folder) {
    return part_manifest(part_place(part), manifest_file(options.manifest), folder);
  };
  static_cast<void>(manifest({}));  // a wrong manifest is refused before the user is asked
  if (kind.moves_joints && !options.yes && !agreed(kind.what)) return exit_status::kUsage;
  note_signals();
  return check_in_run(options, [&](const std::filesystem::path& folder) {
    return run_manifest(
        manifest(folder), folder, [] { return signal_number() != 0; }, print_line);
  });
}

}  // namespace constrictor::conform
