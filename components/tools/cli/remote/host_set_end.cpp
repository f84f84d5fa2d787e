// The end of a run on several hosts: their files are fetched, and their agents end.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "cli/remote/host_set.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kCollectBound = 60s;   // without a byte
constexpr auto kCollectStep = 200ms;  // between two looks for a signal of the user
constexpr auto kCollectSilence = 5s;  // before the user is told what takes so long
constexpr auto kHostsEndBound = 6s;

}  // namespace

HostSet::~HostSet() { end_agents(); }

void HostSet::end_agents() {
  const auto over = [](const auto& link) { return link->ended() || !link->up(); };
  try {
    for (const auto& link : links_) link->end(keep_at_end_);
    exchange_until([&] { return std::all_of(links_.begin(), links_.end(), over); }, kHostsEndBound);
  } catch (const std::exception&) {  // the agents end by themselves
  }
}

void HostSet::collect_files(const std::function<bool()>& done) {
  using Clock = std::chrono::steady_clock;
  const auto bytes = [this] {
    std::uintmax_t sum = 0;
    for (const auto& link : links_) sum += link->collected_bytes();
    return sum;
  };
  const auto begin = Clock::now();
  auto progress = begin;
  bool printed = false;
  try {
    // A recording may be large, and a link slow: as long as bytes arrive, only a signal of the user ends the wait.
    for (auto before = bytes(); !exchange_until(done, kCollectStep) && Clock::now() - progress < kCollectBound;
         wait_()) {
      if (const auto now = bytes(); now != std::exchange(before, now)) progress = Clock::now();
      if (Clock::now() - begin < kCollectSilence || std::exchange(printed, true)) continue;
      print_("fetching the files that processes on other hosts wrote; Ctrl-C leaves them there");
    }
  } catch (const std::exception& error) {
    print_(fmt::format("{}; the files that have not arrived stay where they are", error.what()));
  } catch (...) {  // a signal of the user, which the launcher throws from wait_()
    print_("interrupted; the files that have not arrived stay where they are");
  }
}

void HostSet::finish(bool over) {
  keep_at_end_ = options_.keep && !over;
  const auto all = [this](auto condition) {
    return std::all_of(links_.begin(), links_.end(), [&](const auto& link) { return !link->up() || condition(*link); });
  };
  for (const auto& link : links_) link->collect(report_dir_);
  // A run that is over waits for a host that is away for a moment; one that was killed does not.
  collect_files([&] {
    return std::all_of(links_.begin(), links_.end(),
                       [&](const auto& link) { return link->collected() || link->lost() || (!over && !link->up()); });
  });
  for (const auto& link : links_) {
    const std::string missing = link->missing_files();
    if (!missing.empty()) print_(fmt::format("host {}: {}", link->name(), missing));
    if (!link->up())
      print_(
          fmt::format("host {}: its agent ends all its processes within {:g} s", link->name(), manifest_.patience_s));
    link->end(keep_at_end_ || !missing.empty());
  }
  exchange_until([&] { return all([](const HostLink& link) { return link.ended(); }); }, kHostsEndBound);
}

}  // namespace constrictor::cli
