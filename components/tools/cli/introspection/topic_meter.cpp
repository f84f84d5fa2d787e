// `constrictor topic hz`, `bw` and `delay`: rates, bandwidths and delays of topics.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/introspection/topic_watch.hpp"
#include "configuration/counted.hpp"
#include "constrictor/json.hpp"
#include "recording/message_cdr.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Mean, smallest, largest and standard deviation of a series (Welford's method).
struct Statistics {
  std::uint64_t count = 0;
  double mean = 0.0;
  double squares = 0.0;
  double least = 0.0;
  double greatest = 0.0;
  void add(double value) {
    least = count == 0 ? value : std::min(least, value);
    greatest = count == 0 ? value : std::max(greatest, value);
    const double step = value - mean;
    mean += step / static_cast<double>(++count);
    squares += step * (value - mean);
  }
  [[nodiscard]] double deviation() const {
    return count > 1 ? std::sqrt(squares / static_cast<double>(count - 1)) : 0.0;
  }
};

/// Samples and bytes between the first and the last sample, in one clock.
struct Span {
  double first_s = 0.0;
  double last_s = 0.0;
  std::uint64_t samples = 0;
  std::uint64_t bytes = 0;  ///< of all samples but the first, which came before the span
  void add(double now_s, std::size_t size) {
    if (samples++ == 0) first_s = now_s;
    else bytes += size;
    last_s = now_s;
  }
  [[nodiscard]] bool any() const { return samples > 1 && last_s > first_s; }
  [[nodiscard]] double rate_hz() const { return any() ? static_cast<double>(samples - 1) / (last_s - first_s) : 0.0; }
  [[nodiscard]] double bytes_per_s() const { return any() ? static_cast<double>(bytes) / (last_s - first_s) : 0.0; }
};

/// One topic.
struct Meter {
  std::string topic;
  const MessageCodec* codec = nullptr;  ///< null: not a type of this project, so that its time is not known
  Span wall;
  Span robot;  ///< in the time of the robot
  Statistics interval_s;
  Statistics size;

  void add(const dds::RawSample& sample, double now_s) {
    if (wall.samples > 0) interval_s.add(now_s - wall.last_s);
    wall.add(now_s, sample.bytes.size());
    size.add(static_cast<double>(sample.bytes.size()));
    const auto header = codec ? codec->header(sample.bytes) : std::nullopt;
    if (!header) return;
    const double time_s = static_cast<double>(header->time_ns) * 1e-9;
    if (robot.samples > 0 && time_s < robot.last_s) robot = {};  // the run was reset
    robot.add(time_s, sample.bytes.size());
  }
  [[nodiscard]] Json json() const {
    const auto in_robot_time = [this](double value) { return robot.any() ? Json(value) : Json(nullptr); };
    return {{"topic", topic},
            {"samples", wall.samples},
            {"rate_hz", wall.rate_hz()},
            {"robot_rate_hz", in_robot_time(robot.rate_hz())},
            {"least_interval_s", interval_s.least},
            {"greatest_interval_s", interval_s.greatest},
            {"deviation_s", interval_s.deviation()},
            {"bytes_per_s", wall.bytes_per_s()},
            {"bytes_per_robot_s", in_robot_time(robot.bytes_per_s())},
            {"least_bytes", size.least},
            {"greatest_bytes", size.greatest}};
  }
};

std::string amount(double bytes) {
  return bytes >= 1e6   ? fmt::format("{:.2f} MB", bytes * 1e-6)
         : bytes >= 1e3 ? fmt::format("{:.2f} kB", bytes * 1e-3)
                        : fmt::format("{:.0f} B", bytes);
}

std::string rate_text(const Meter& meter) {
  std::string text = fmt::format("{:.2f} Hz", meter.wall.rate_hz());
  if (meter.robot.any()) text += fmt::format(" ({:.2f} Hz in the robot's time)", meter.robot.rate_hz());
  return text + fmt::format(", {}, {:.1f} to {:.1f} ms apart, deviation {:.1f} ms; {:.0f} bytes each",
                            counted(meter.wall.samples, "sample"), meter.interval_s.least * 1e3,
                            meter.interval_s.greatest * 1e3, meter.interval_s.deviation() * 1e3, meter.size.mean);
}

std::string bandwidth_text(const Meter& meter) {
  std::string text = amount(meter.wall.bytes_per_s()) + "/s";
  if (meter.robot.any()) text += fmt::format(" ({}/s in the robot's time)", amount(meter.robot.bytes_per_s()));
  return text + fmt::format(", {} of {} to {}, {} on average", counted(meter.wall.samples, "sample"),
                            amount(meter.size.least), amount(meter.size.greatest), amount(meter.size.mean));
}

int measure(const ViewOptions& view, const WatchOptions& options, std::string (*text_of)(const Meter&)) {
  std::vector<Meter> meters(options.topics.size());
  std::size_t width = 0;
  for (std::size_t i = 0; i < meters.size(); ++i) {
    meters[i].topic = options.topics[i];
    width = std::max(width, options.topics[i].size());
  }
  double printed_s = 0.0;
  const auto print = [&] {
    for (const Meter& meter : meters) {
      if (meters.size() > 1) fmt::print("{:<{}}  ", meter.topic, width);
      fmt::print("{}\n", meter.wall.samples == 0 ? "no sample" : text_of(meter));
    }
    std::fflush(stdout);
  };
  Watcher watcher;
  watcher.begin = [&](const DomainView&, std::size_t topic, const dds::Endpoint& writer) {
    constexpr std::string_view kModule = "constrictor::msg::";
    if (writer.type.starts_with(kModule)) meters[topic].codec = find_codec(writer.type.substr(kModule.size()));
  };
  watcher.use = [&](std::size_t topic, const dds::RawSample& sample, double now_s) {
    meters[topic].add(sample, now_s);
    return true;
  };
  watcher.turn = [&](double now_s) {
    if (view.json || now_s - printed_s < 1.0) return;
    printed_s = now_s;
    print();
  };
  const int status = watch_topics(view, options, watcher);
  const bool any = std::any_of(meters.begin(), meters.end(), [](const Meter& meter) { return meter.wall.samples > 0; });
  if (!any) return status == exit_status::kOk ? kNothingArrived : status;
  if (view.json) {
    Json list = Json::array();
    for (const Meter& meter : meters) list.push_back(meter.json());
    fmt::print("{}\n", json_text(list.size() == 1 ? list.front() : list));
  } else {
    print();
  }
  return exit_status::kOk;
}

}  // namespace

int hz_command(const ViewOptions& view, const WatchOptions& options) { return measure(view, options, rate_text); }
int bw_command(const ViewOptions& view, const WatchOptions& options) { return measure(view, options, bandwidth_text); }

int delay_command(const ViewOptions& view, const WatchOptions& options) {
  Statistics delay;
  double told_s = 0.0;
  const auto tell = [&] {
    fmt::print("delay {:.3f} ms, {:.3f} to {:.3f} ms, deviation {:.3f} ms, {}\n", delay.mean * 1e3, delay.least * 1e3,
               delay.greatest * 1e3, delay.deviation() * 1e3, counted(delay.count, "sample"));
    std::fflush(stdout);
  };
  Watcher watcher;
  watcher.use = [&](std::size_t, const dds::RawSample& sample, double now_s) {
    const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
    const auto now_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(since_1970).count();
    delay.add(static_cast<double>(now_ns - sample.source_time_ns) * 1e-9);
    if (!view.json && now_s - told_s >= 1.0) {
      told_s = now_s;
      tell();
    }
    return true;
  };
  const int status = watch_topics(view, options, watcher);
  if (status != exit_status::kOk && delay.count == 0) return status;
  if (view.json) {
    const Json json = {
        {"topic", options.topics.front()}, {"samples", delay.count},       {"mean_s", delay.mean},
        {"least_s", delay.least},          {"greatest_s", delay.greatest}, {"deviation_s", delay.deviation()}};
    fmt::print("{}\n", json_text(json));
  } else {
    tell();
  }
  return delay.count > 0 ? exit_status::kOk : kNothingArrived;
}

}  // namespace constrictor::cli
