#include "barrier/history_depth.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "constrictor/topics.hpp"

namespace constrictor {
namespace {

int divided_upwards(int number, int divisor) { return (number + divisor - 1) / divisor; }

std::optional<std::string> unheard_steps(const Hello& member) {
  const int steps = divided_upwards(member.timing.latency, member.timing.period);
  if (steps <= barrier_topics::kTickDone.depth) return {};
  return fmt::format("latency_ticks of {}: found {}, accepted at most {}, because {} keeps the reports of {} steps",
                     member.component, member.timing.latency, barrier_topics::kTickDone.depth * member.timing.period,
                     barrier_topics::kTickDone.name, barrier_topics::kTickDone.depth);
}

/// [ticks] between two images of the camera; empty if no member is a camera.
std::optional<int> image_period(const std::vector<Hello>& members) {
  for (const auto& member : members) {
    if (member.writes.contains(topics::kCameraImage.id)) return member.timing.period;
  }
  return {};
}

}  // namespace

int needed_history(int writer_latency, int interval, int reader_latency) {
  return 1 + divided_upwards(writer_latency + reader_latency - 1, interval);
}

std::optional<std::string> depth_violation(const std::vector<Hello>& members, const std::string& plant) {
  const std::optional<int> images = image_period(members);
  for (const auto& reader : members) {
    if (auto why = unheard_steps(reader)) return why;
    for (const auto& writer : members) {
      const int writer_latency = writer.component == plant ? 0 : writer.timing.latency;
      for (const auto& topic : topics::kInfos) {
        if (!writer.writes.contains(topic.id) || !reader.reads.contains(topic.id)) continue;
        if (topic.rate == "once an epoch") continue;  // its only sample stays
        // A component that steps at every tick, but writes only after an image, is as fast as the camera at most.
        const bool after_images = topic.rate.find(" image") != std::string_view::npos;
        if (after_images && !images) continue;
        const int interval = std::max<int>(writer.timing.period, after_images ? *images : 1);
        const int needed = needed_history(writer_latency, interval, reader.timing.latency);
        const int kept = topic.depth / topic.max_per_tick;
        if (needed <= kept) continue;
        return fmt::format(
            "latency_ticks: found {} of {}, which writes {}, and {} of {}, which reads it: a restarted reader would "
            "need the samples of {} steps, but the topic keeps {}; choose a smaller latency (of the camera: "
            "camera.latency_ticks of the robot file, of the others: latency_ticks of the manifest)",
            writer_latency, writer.component, topic.name, reader.timing.latency, reader.component, needed, kept);
      }
    }
  }
  return {};
}

}  // namespace constrictor
