#include "cli/introspection/domain_view.hpp"

#include <fmt/format.h>

#include <set>
#include <thread>

#include "cli/usage.hpp"
#include "client/run_registry.hpp"
#include "common/interrupt.hpp"
#include "configuration/closest_name.hpp"
#include "constrictor/topics.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

}  // namespace

void add_view_options(CLI::App& app, ViewOptions& options) {
  app.add_option("--run,--domain", options.domain,
                 "DDS domain of the run, or any other domain (default: the only run on this host)")
      ->envname("CONSTRICTOR_DOMAIN")
      ->check(whole_number(0, 229));
  app.add_flag("--json", options.json, "print JSON instead of text, for scripts");
}

DomainView::DomainView(const ViewOptions& options)
    : number_(find_domain(options.domain)), domain_(number_), discovery_(domain_.participant()) {}

bool DomainView::settle(std::chrono::milliseconds bound) const {
  const auto end = Clock::now() + bound;
  auto changed = Clock::now();
  std::size_t before = 0;
  while (Clock::now() < end) {
    const std::size_t now = discovery_.endpoints().size();
    if (now != before) changed = Clock::now();
    before = now;
    if (now > 0 && Clock::now() - changed > 250ms) break;
    std::this_thread::sleep_for(20ms);
  }
  return before > 0;
}

void DomainView::settle_or_throw() const {
  if (settle()) return;
  std::string runs;
  for (const auto& run : live_runs()) runs += fmt::format("{}{}", runs.empty() ? "" : ", ", run.domain);
  throw CommandError(fmt::format("no process in DDS domain {}; {}", number_,
                                 runs.empty() ? "no run on this host (start one with `constrictor run`)"
                                              : "the runs on this host are in " + runs));
}

std::optional<dds::Endpoint> DomainView::find_writer(const std::string& topic, std::chrono::milliseconds bound) const {
  const auto end = Clock::now() + bound;
  do {
    for (const auto& endpoint : discovery_.endpoints()) {
      if (endpoint.writer && endpoint.topic == topic) return endpoint;
    }
    std::this_thread::sleep_for(20ms);
  } while (Clock::now() < end && !interrupted());
  return std::nullopt;
}

std::string DomainView::name_of(const dds::Guid& participant, const std::vector<dds::Participant>& participants,
                                const std::vector<dds::Endpoint>& endpoints) {
  for (const auto& endpoint : endpoints) {
    if (endpoint.participant == participant && !endpoint.user_data.empty()) return endpoint.user_data;
  }
  for (const auto& known : participants) {
    if (known.guid == participant && !known.program.empty()) return known.program;
  }
  return dds::short_name(participant);
}

std::vector<std::string> topic_names(const DomainView& view) {
  std::set<std::string> names;
  for (const auto& info : topics::kInfos) names.emplace(info.name);
  for (const auto& info : barrier_topics::kInfos) names.emplace(info.name);
  for (const auto& endpoint : view.discovery().endpoints()) names.insert(endpoint.topic);
  return {names.begin(), names.end()};
}

std::string no_such_topic(const DomainView& view, const std::string& topic) {
  return fmt::format("no topic '{}' in DDS domain {}{} (see `constrictor topic list`)", topic, view.domain(),
                     did_you_mean(topic, topic_names(view)));
}

bool interrupted() {
  // These commands change nothing in a run, so the other signals may end them at once.
  static const bool listening = (catch_interrupts({SIGINT, SIGTERM}), true);
  return listening && interrupt_signal() != 0;
}

}  // namespace constrictor::cli
