#include "cli/introspection/topic_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/introspection/readable_sample.hpp"
#include "client/command_error.hpp"
#include "constrictor/json.hpp"
#include "constrictor/reflect.hpp"
#include "constrictor/sha256.hpp"
#include "cyclone/kept_samples.hpp"
#include "cyclone/raw_reader.hpp"
#include "cyclone/type_tree.hpp"
#include "cyclone/wait_set.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr int kNothingArrived = 1;      // exit status
constexpr auto kDiscovery = 1500ms;     // by then a writer that exists has been found
constexpr std::size_t kMostShown = 64;  // bytes of a sample in text

/// Prints a sample as YAML, with an array of numbers on one line.
void print_fields(const Json& value, int depth) {
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  for (const auto& [name, field] : value.items()) {
    const bool nested = field.is_object() || (field.is_array() && !field.empty() && field.front().is_object());
    if (!nested) {
      fmt::print("{}{}: {}\n", indent, name, field.is_string() ? field.get<std::string>() : json_text(field));
    } else {
      fmt::print("{}{}:\n", indent, name);
      print_fields(field, depth + 1);
    }
  }
}

Json raw_json(const dds::RawSample& sample) { return {{"size", sample.bytes.size()}, {"cdr", hex(sample.bytes)}}; }

void print_raw(const dds::RawSample& sample, const char* why) {
  fmt::print("{} bytes of CDR ({}):\n", sample.bytes.size(), why);
  for (std::size_t i = 0; i < std::min(kMostShown * 4, sample.bytes.size()); i += 16) {
    fmt::print("  {:04x} ", i);
    for (std::size_t j = i; j < std::min(i + 16, sample.bytes.size()); ++j) fmt::print(" {:02x}", sample.bytes[j]);
    fmt::print("\n");
  }
  if (sample.bytes.size() > kMostShown * 4) fmt::print("  ... and {} more\n", sample.bytes.size() - kMostShown * 4);
}

/// The part of a sample that --field names. Empty if the sample has no such field; `accepted` is then set to a text
/// that names what was found and what is accepted.
std::optional<Json> part(const Json& sample, const std::string& field, std::string& accepted) {
  const Json* at = &sample;
  for (const auto& name : CLI::detail::split(field, '.')) {
    const bool index = !name.empty() && name.size() < 10 && name.find_first_not_of("0123456789") == std::string::npos;
    if (at->is_array() && index && std::stoul(name) < at->size()) {
      at = &(*at)[std::stoul(name)];
    } else if (at->is_object() && at->contains(name)) {
      at = &(*at)[name];
    } else {
      if (at->is_array())
        accepted = at->empty() ? "nothing, because the list is empty" : fmt::format("0 to {}", at->size() - 1);
      else if (!at->is_object()) accepted = "nothing, because a plain value has no parts";
      else
        for (const auto& [key, value] : at->items()) accepted += (accepted.empty() ? "" : ", ") + key;
      accepted = fmt::format("found '{}', accepted {}", name, accepted);
      return std::nullopt;
    }
  }
  return *at;
}

/// Waits for a writer of the topic. Throws CommandError at once if neither the domain nor the project has a topic of
/// this name.
std::optional<dds::Endpoint> wait_for_writer(const DomainView& view, const WatchOptions& options) {
  const auto bound = std::chrono::milliseconds(static_cast<std::int64_t>(options.timeout_s * 1e3));
  if (auto writer = view.find_writer(options.topic, std::min<std::chrono::milliseconds>(bound, kDiscovery)))
    return writer;
  if (interrupted()) return std::nullopt;
  const auto names = topic_names(view);
  if (std::find(names.begin(), names.end(), options.topic) == names.end())
    throw CommandError(no_such_topic(view, options.topic));
  if (bound > kDiscovery) {
    std::fprintf(stderr, "topic: waiting up to %g s for a writer of '%s' in DDS domain %u\n", options.timeout_s,
                 options.topic.c_str(), view.domain());
    if (auto writer = view.find_writer(options.topic, bound - kDiscovery)) return writer;
  }
  if (!interrupted())
    std::fprintf(stderr, "topic: no writer of '%s' in DDS domain %u\n", options.topic.c_str(), view.domain());
  return std::nullopt;
}

/// Calls `use` for each sample until it returns false, the user interrupts, `for_s` has passed, or no sample has
/// arrived for the timeout. `begin` is called once, when a writer was found. `history`: begins with the samples that
/// the writers keep for late readers; if a number of samples is wanted, with the newest of them.
template <class Use, class Begin>
int watch(const ViewOptions& options, const WatchOptions& watched, bool history, Begin&& begin, Use&& use) {
  const DomainView view(options);
  const auto writer = wait_for_writer(view, watched);
  if (!writer) return interrupted() ? exit_status::kOk : kNothingArrived;
  const auto bound = std::chrono::milliseconds(static_cast<std::int64_t>(watched.timeout_s * 1e3));
  begin(view, *writer);
  const dds::RawReader reader(view.participant(), *writer, history);
  const dds::WaitSet wait_set(view.participant());
  wait_set.attach(reader.get());
  const auto start = Clock::now();
  auto last = start;
  bool more = true;
  std::optional<dds::KeptSamples> kept;
  if (history && watched.count > 0) kept.emplace(dds::KeptSamples::now_ns());
  std::vector<std::uint8_t> newest;
  while (more && !interrupted()) {
    wait_set.wait(kept ? dds::KeptSamples::kQuiet : 100ms);
    const auto now = Clock::now();
    const auto pass_on = [&](const dds::RawSample& sample) {
      if (more) more = use(sample, std::chrono::duration<double>(now - start).count());
    };
    const auto pass_newest_on = [&] {
      if (!kept || !kept->complete(now)) return;
      kept.reset();
      pass_on({newest, 0});
    };
    reader.take([&](const dds::RawSample& sample) {
      last = now;
      if (!kept) return pass_on(sample);
      kept->arrived(sample.source_time_ns, now);
      newest.assign(sample.bytes.begin(), sample.bytes.end());
      pass_newest_on();
    });
    pass_newest_on();
    if (watched.for_s > 0 && now - start > std::chrono::duration<double>(watched.for_s)) {
      if (last == start)
        std::fprintf(stderr, "topic: no sample of '%s' within %g s\n", watched.topic.c_str(), watched.for_s);
      break;
    }
    if (now - last > bound) {
      std::fprintf(stderr, "topic: no sample of '%s' for %g s\n", watched.topic.c_str(), watched.timeout_s);
      return kNothingArrived;
    }
  }
  return exit_status::kOk;
}

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

}  // namespace

int echo_command(const ViewOptions& view, const WatchOptions& options) {
  std::unique_ptr<dds::TypeTree> tree;
  std::string type;
  std::uint64_t seen = 0;
  std::string wrong;
  const auto begin = [&](const DomainView& domain, const dds::Endpoint& writer) {
    type = writer.type;
    if (options.raw) return;
    tree = dds::TypeTree::find(domain.participant(), writer, 2s);
    if (!tree) tree = dds::TypeTree::known(domain.participant(), writer.type);
  };
  const int status = watch(view, options, true, begin, [&](const dds::RawSample& sample, double) {
    const char* why = options.raw ? "--raw" : "its writer does not describe the type";
    Json json;
    if (tree) {
      try {
        json = tree->decode(sample.bytes);
        make_readable(json, type, view.json ? Arrays::kWhole : Arrays::kUsed);
        if (!options.field.empty()) {
          const auto found = part(json, options.field, wrong);
          if (!found) return false;
          json = *found;
        }
      } catch (const std::exception& error) {
        why = "it does not fit the type that its writer describes";
      }
    }
    if (view.json) {
      fmt::print("{}\n", (json.is_null() && options.field.empty() ? raw_json(sample) : json)
                             .dump(-1, ' ', false, Json::error_handler_t::replace));
    } else if (json.is_null() && (options.field.empty() || !tree)) {
      print_raw(sample, why);
    } else if (json.is_object()) {
      print_fields(json, 0);
      fmt::print("---\n");
    } else {
      fmt::print("{}\n", json.is_string() ? json.get<std::string>() : json_text(json));
    }
    std::fflush(stdout);
    return options.count == 0 || ++seen < options.count;
  });
  if (wrong.empty()) return status;
  std::fprintf(stderr, "topic: --field of '%s': %s\n", options.topic.c_str(), wrong.c_str());
  return exit_status::kUsage;
}

int hz_command(const ViewOptions& view, const WatchOptions& options) {
  Statistics interval;
  double first_s = 0.0;
  double last_s = 0.0;
  double told_s = 0.0;
  std::uint64_t count = 0;
  std::uint64_t bytes = 0;
  const auto rate = [&] {
    return count > 1 && last_s > first_s ? static_cast<double>(count - 1) / (last_s - first_s) : 0.0;
  };
  const int status = watch(
      view, options, false, [](const auto&, const auto&) {},
      [&](const dds::RawSample& sample, double now_s) {
        if (count == 0) first_s = now_s;
        else interval.add(now_s - last_s);
        last_s = now_s;
        ++count;
        bytes += sample.bytes.size();
        if (!view.json && now_s - told_s >= 1.0) {
          told_s = now_s;
          fmt::print("{:.2f} Hz, {} samples, between two: {:.1f} to {:.1f} ms, deviation {:.1f} ms; {} bytes each\n",
                     rate(), count, interval.least * 1e3, interval.greatest * 1e3, interval.deviation() * 1e3,
                     bytes / count);
          std::fflush(stdout);
        }
        return true;
      });
  if (status != exit_status::kOk && count == 0) return status;
  if (view.json) {
    const Json json = {
        {"topic", options.topic},
        {"samples", count},
        {"rate_hz", rate()},
        {"least_interval_s", interval.least},
        {"greatest_interval_s", interval.greatest},
        {"deviation_s", interval.deviation()},
        {"bytes_per_s", count > 1 && last_s > first_s ? static_cast<double>(bytes) / (last_s - first_s) : 0.0}};
    fmt::print("{}\n", json_text(json));
  } else {
    fmt::print("{:.2f} Hz over {} samples\n", rate(), count);
  }
  return count > 0 ? exit_status::kOk : kNothingArrived;
}

int delay_command(const ViewOptions& view, const WatchOptions& options) {
  Statistics delay;
  double told_s = 0.0;
  const auto tell = [&] {
    fmt::print("delay {:.3f} ms, {:.3f} to {:.3f} ms, deviation {:.3f} ms, {} samples\n", delay.mean * 1e3,
               delay.least * 1e3, delay.greatest * 1e3, delay.deviation() * 1e3, delay.count);
    std::fflush(stdout);
  };
  const int status = watch(
      view, options, false, [](const auto&, const auto&) {},
      [&](const dds::RawSample& sample, double now_s) {
        const auto now_ns =
            std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
                .count();
        delay.add(static_cast<double>(now_ns - sample.source_time_ns) * 1e-9);
        if (!view.json && now_s - told_s >= 1.0) {
          told_s = now_s;
          tell();
        }
        return true;
      });
  if (status != exit_status::kOk && delay.count == 0) return status;
  if (view.json) {
    const Json json = {{"topic", options.topic}, {"samples", delay.count},       {"mean_s", delay.mean},
                       {"least_s", delay.least}, {"greatest_s", delay.greatest}, {"deviation_s", delay.deviation()}};
    fmt::print("{}\n", json_text(json));
  } else {
    tell();
  }
  return delay.count > 0 ? exit_status::kOk : kNothingArrived;
}

}  // namespace constrictor::cli
