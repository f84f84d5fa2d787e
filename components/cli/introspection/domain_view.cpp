#include "cli/introspection/domain_view.hpp"

#include <csignal>
#include <thread>

#include "cli/run_registry.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/dds/wire.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t g_interrupted = 0;
void on_signal(int) { g_interrupted = 1; }

}  // namespace

void add_view_options(CLI::App& app, ViewOptions& options) {
  app.add_option("--run", options.domain, "DDS domain of the run, or any other domain (default: the only run there is)")
      ->envname("CONSTRICTOR_DOMAIN")->check(CLI::Range(0, 229));
  app.add_flag("--json", options.json, "for scripts: JSON instead of text");
}

std::uint32_t chosen_domain(const ViewOptions& options) { return options.domain ? *options.domain : find_run(std::nullopt).domain; }

DomainView::DomainView(const ViewOptions& options)
    : number_(chosen_domain(options)), domain_(number_), discovery_(domain_.participant()) {}

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

std::map<std::string, Member> DomainView::members() const {
  const auto hellos = dds::Reader<msg::Hello>::member(participant(), dds::barrier_topics::kHello);
  const auto statuses = dds::Reader<msg::ComponentStatus>::member(participant(), dds::barrier_topics::kStatus);
  std::map<std::string, Member> found;
  // What writers keep for late readers follows the match at once; nothing more comes of members that never spoke.
  const auto end = Clock::now() + 1500ms;
  auto changed = Clock::now();
  while (Clock::now() < end && Clock::now() - changed < 300ms) {
    hellos.take([&](const msg::Hello& hello) {
      auto& member = found[hello.component];
      if (!member.hello || member.hello->incarnation <= hello.incarnation) member.hello = hello;
      changed = Clock::now();
    });
    statuses.take([&](const msg::ComponentStatus& status) {
      auto& member = found[status.component];
      if (!member.status) changed = Clock::now();
      if (!member.status || member.status->incarnation <= status.incarnation) member.status = status;
    });
    std::this_thread::sleep_for(10ms);
  }
  return found;
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

bool interrupted() {
  static const bool listening = [] {
    struct sigaction action {};
    action.sa_handler = on_signal;
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
    return true;
  }();
  return listening && g_interrupted != 0;
}

}  // namespace constrictor::cli
