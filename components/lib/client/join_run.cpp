// join_run(): a run that no launcher on this host has noted, found by the messages that it publishes.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "client/polling.hpp"
#include "client/run_registry.hpp"
#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {
namespace {

/// The description of a run by the messages in its domain.
class Discovered {
 public:
  explicit Discovered(std::uint32_t domain)
      : domain_(domain),
        states_(dds::Reader<msg::RunState>::member(domain_.participant(), barrier_topics::kRunState)),
        starts_(dds::Reader<msg::EpochStart>::member(domain_.participant(), barrier_topics::kEpochStart)),
        hellos_(dds::Reader<msg::Hello>::member(domain_.participant(), barrier_topics::kHello)) {
    note_.domain = domain;
    note_.on_this_host = false;
    note_.scenario = "?";
  }

  /// Returns whether something new has arrived.
  bool poll() {
    bool any = false;
    states_.take([&](const msg::RunState& state) {
      if (note_.run_id == 0) any = true;
      note_.run_id = state.run_id;
      note_.seed = state.seed;
    });
    starts_.take([&](const msg::EpochStart& start) { note_.scenario = stem(printable(text_of(start.scenario))); });
    hellos_.take([&](const msg::Hello& hello) {
      const std::string name = printable(text_of(hello.component));
      if (roster_.size() < msg::kMaxMembers) any = roster_.emplace(name, hello.run_id).second || any;
    });
    return any;
  }
  [[nodiscard]] bool begun() const { return note_.run_id != 0; }

  [[nodiscard]] RunNote note() {
    for (const auto& [name, run_id] : roster_) {
      if (run_id == 0 || run_id == note_.run_id) note_.roster.push_back(name);
    }
    // The conductor's writers carry the name of the plant, in whose process it is.
    const auto names = dds::matched_user_data(states_.get(), false);
    if (!names.empty()) note_.plant = printable(names.front());
    return note_;
  }

 private:
  static std::string stem(const std::string& file) { return file.substr(0, file.rfind('.')); }

  RunNote note_;
  dds::Domain domain_;
  dds::Reader<msg::RunState> states_;
  dds::Reader<msg::EpochStart> starts_;
  dds::Reader<msg::Hello> hellos_;
  std::map<std::string, std::uint64_t> roster_;  ///< run id by component
};

}  // namespace

RunNote join_run(std::optional<std::uint32_t> domain, std::chrono::milliseconds bound) {
  if (!domain) return find_run(domain);
  if (auto noted = live_run(*domain)) return std::move(*noted);
  Discovered discovered(*domain);
  wait_until_quiet(
      kQuiet, bound, [&] { return discovered.poll(); }, [&] { return discovered.begun(); });
  if (!discovered.begun()) {
    throw CommandError(fmt::format("no run in DDS domain {}: no launcher on this host has noted one, and no plant "
                                   "publishes `run_state` there (for a run on another host, set CYCLONEDDS_URI as "
                                   "deploy/README.md explains)",
                                   *domain),
                       CommandError::Cause::kNoRun);
  }
  return discovered.note();
}

}  // namespace constrictor
