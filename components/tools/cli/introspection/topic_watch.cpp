#include "cli/introspection/topic_watch.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <deque>
#include <optional>

#include "client/command_error.hpp"
#include "cyclone/kept_samples.hpp"
#include "cyclone/wait_set.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kDiscovery = 1500ms;  // by then a writer that exists has been found

std::chrono::milliseconds milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1e3));
}

/// Waits for a writer of a topic until `end`. Throws CommandError at once if neither the domain nor the project has a
/// topic of this name.
std::optional<dds::Endpoint> wait_for_writer(const DomainView& view, const std::string& topic, double timeout_s,
                                             Clock::time_point end) {
  const auto left = [&] { return std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now()); };
  if (auto writer = view.find_writer(topic, std::min<std::chrono::milliseconds>(left(), kDiscovery))) return writer;
  if (interrupted()) return std::nullopt;
  const auto names = topic_names(view);
  if (std::find(names.begin(), names.end(), topic) == names.end()) throw CommandError(no_such_topic(view, topic));
  if (left() > 0ms) {
    std::fprintf(stderr, "topic: waiting up to %g s for a writer of '%s' in DDS domain %u\n", timeout_s, topic.c_str(),
                 view.domain());
    if (auto writer = view.find_writer(topic, left())) return writer;
  }
  if (!interrupted()) std::fprintf(stderr, "topic: no writer of '%s' in DDS domain %u\n", topic.c_str(), view.domain());
  return std::nullopt;
}

/// One topic: its reader, and the newest of the samples that the writers keep, while they arrive.
struct Watched {
  std::size_t index;
  dds::RawReader reader;
  std::optional<dds::KeptSamples> kept;
  std::vector<std::uint8_t> newest;
};

std::string listed(const std::vector<std::string>& topics) {
  std::string text;
  for (const auto& topic : topics) text += (text.empty() ? "'" : ", '") + topic + "'";
  return text;
}

}  // namespace

int watch_topics(const ViewOptions& options, const WatchOptions& watched, const Watcher& watcher) {
  const DomainView view(options);
  const auto bound = milliseconds(watched.timeout_s);
  const auto writers_by = Clock::now() + bound;
  const dds::WaitSet wait_set(view.participant());
  std::deque<Watched> all;
  for (std::size_t i = 0; i < watched.topics.size(); ++i) {
    const auto writer = wait_for_writer(view, watched.topics[i], watched.timeout_s, writers_by);
    if (!writer) return interrupted() ? exit_status::kOk : kNothingArrived;
    if (watcher.begin) watcher.begin(view, i, *writer);
    all.push_back({i, dds::RawReader(view.participant(), *writer, watcher.history), {}, {}});
    if (watcher.history && watched.count > 0) all.back().kept.emplace(dds::KeptSamples::now_ns());
    wait_set.attach(all.back().reader.get());
  }
  const auto start = Clock::now();
  auto last = start;
  auto turned = start;
  bool more = true;
  while (more && !interrupted()) {
    const bool settling =
        std::any_of(all.begin(), all.end(), [](const Watched& each) { return each.kept.has_value(); });
    wait_set.wait(settling ? dds::KeptSamples::kQuiet : 100ms);
    const auto now = Clock::now();
    const double now_s = std::chrono::duration<double>(now - start).count();
    for (Watched& each : all) {
      const auto pass_on = [&](const dds::RawSample& sample) {
        if (more) more = watcher.use(each.index, sample, now_s);
      };
      const auto pass_newest_on = [&] {
        if (!each.kept || !each.kept->complete(now)) return;
        each.kept.reset();
        pass_on({each.newest, 0});
      };
      each.reader.take([&](const dds::RawSample& sample) {
        last = now;
        if (!each.kept) return pass_on(sample);
        each.kept->arrived(sample.source_time_ns, now);
        each.newest.assign(sample.bytes.begin(), sample.bytes.end());
        pass_newest_on();
      });
      pass_newest_on();
    }
    if (watcher.turn && more && now - turned >= 100ms) {
      turned = now;
      watcher.turn(now_s);
    }
    if (watched.for_s > 0 && now_s > watched.for_s) {
      if (last == start)
        std::fprintf(stderr, "topic: no sample of %s within %g s\n", listed(watched.topics).c_str(), watched.for_s);
      break;
    }
    if (now - last > bound) {
      std::fprintf(stderr, "topic: no sample of %s for %g s\n", listed(watched.topics).c_str(), watched.timeout_s);
      return kNothingArrived;
    }
  }
  return exit_status::kOk;
}

}  // namespace constrictor::cli
