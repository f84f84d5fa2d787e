#include "cli/introspection/topic_pub.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "cli/introspection/readable_sample.hpp"
#include "cli/introspection/sample_view.hpp"
#include "cli/usage.hpp"
#include "client/source.hpp"
#include "client/topic_publisher.hpp"
#include "configuration/counted.hpp"
#include "configuration/yaml_document.hpp"
#include "constrictor/json.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr int kNobodyReads = 1;  // exit status
constexpr auto kFlush = 2s;
// A reader may discover this writer a moment after the writer has discovered it, and commands are not kept for late
// readers. So a single command is repeated; its reader obeys it once.
constexpr int kRepeats = 3;
constexpr auto kRepeatEvery = 200ms;

Json json_of(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Map: {
      Json made = Json::object();
      for (const auto& entry : node) {
        const auto key = entry.first.as<std::string>();
        if (made.contains(key)) throw YAML::ParserException(entry.first.Mark(), fmt::format("{} a second time", key));
        made[key] = json_of(entry.second);
      }
      return made;
    }
    case YAML::NodeType::Sequence: {
      Json made = Json::array();
      for (const auto& entry : node) made.push_back(json_of(entry));
      return made;
    }
    case YAML::NodeType::Scalar:
      break;
    default:
      return nullptr;
  }
  if (node.Tag() == "!") return node.Scalar();  // in quotes
  std::int64_t whole = 0;
  if (YAML::convert<std::int64_t>::decode(node, whole)) return whole;
  std::uint64_t natural = 0;
  if (YAML::convert<std::uint64_t>::decode(node, natural)) return natural;
  double real = 0.0;
  if (YAML::convert<double>::decode(node, real)) return std::isnan(real) ? Json(nullptr) : Json(real);
  bool truth = false;
  if (YAML::convert<bool>::decode(node, truth)) return truth;
  return node.Scalar();
}

std::string text_of(const PubOptions& options) {
  if (options.file.empty()) return options.message;
  if (options.file == "-") return {std::istreambuf_iterator<char>(std::cin), {}};
  std::ifstream file(options.file);
  if (!file) throw UsageError(fmt::format("--file: found no readable file {}", options.file));
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The bytes of the message with the fields that need not be given. Throws UsageError.
std::vector<std::uint8_t> encoded(TopicPublisher& publisher, const Json& message) {
  try {
    return publisher.encode(publisher.completed(message));
  } catch (const std::invalid_argument& error) {
    throw UsageError(fmt::format("MESSAGE for {}: {}", publisher.type(), error.what()));
  }
}

void print(const TopicPublisher& publisher, const std::vector<std::uint8_t>& bytes, bool json) {
  Json sample = publisher.decode(bytes);
  make_readable(sample, publisher.type(), json ? Arrays::kWhole : Arrays::kUsed);
  fmt::print("{}", json ? json_text(sample) + "\n" : as_text(sample));
}

/// Waits in slices, so that Ctrl-C ends the wait. Returns false then.
bool sleep_until(Clock::time_point time) {
  while (Clock::now() < time && !interrupted())
    std::this_thread::sleep_for(std::min<Clock::duration>(time - Clock::now(), 20ms));
  return !interrupted();
}

/// Waits for a reader. Returns false, with a message to the user, if there is none in time.
bool wait_for_reader(TopicPublisher& publisher, const DomainView& view, const PubOptions& options) {
  const auto end =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.wait_s));
  while (publisher.readers() == 0 && options.wait_s > 0) {
    if (interrupted()) return false;
    if (Clock::now() < end) {
      std::this_thread::sleep_for(10ms);
      continue;
    }
    std::fprintf(stderr, "topic: no reader of '%s' in DDS domain %u; nothing was published (--wait 0 does not wait)\n",
                 options.topic.c_str(), view.domain());
    for (const auto& reader : publisher.mismatched_readers())
      std::fprintf(stderr, "  a reader cannot receive from this command: %s\n", reader.c_str());
    return false;
  }
  return true;
}

int publish_once(TopicPublisher& publisher, const std::vector<std::uint8_t>& bytes, const PubOptions& options) {
  publisher.write(bytes);
  const bool command = publishes_commands(options.topic);
  for (int i = 1; command && i < kRepeats && sleep_until(Clock::now() + kRepeatEvery); ++i) publisher.write(bytes);
  const bool arrived = publisher.flush(kFlush);
  fmt::print("published on {} for {}{}\n", options.topic,
             counted(static_cast<std::uint64_t>(publisher.readers()), "reader"),
             arrived ? "" : "; not every reader has confirmed it within 2 s");
  return exit_status::kOk;
}

}  // namespace

Json parse_message(const std::string& text) {
  Json json = Json::parse(text, nullptr, false);
  if (!json.is_discarded()) return json;
  try {
    json = json_of(parse_yaml(text));
  } catch (const YAML::Exception& error) {
    throw UsageError(fmt::format("MESSAGE: neither JSON nor YAML: line {}, column {}: {}", error.mark.line + 1,
                                 error.mark.column + 1, error.msg));
  }
  return json.is_null() ? Json::object() : json;
}

int pub_command(const ViewOptions& view_options, const PubOptions& options) {
  const Json message = parse_message(text_of(options));
  const DomainView view(view_options);
  TopicPublisher publisher(view.participant(), view.domain(), options.topic, options.type, unique_source("pub"));
  auto bytes = encoded(publisher, message);
  if (options.check) {
    print(publisher, bytes, view_options.json);
    return exit_status::kOk;
  }
  if (!wait_for_reader(publisher, view, options)) return interrupted() ? exit_status::kOk : kNobodyReads;
  if (options.rate_hz <= 0.0) return publish_once(publisher, bytes, options);
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / options.rate_hz));
  const auto start = Clock::now();
  const auto end = start + std::chrono::duration_cast<Clock::duration>(
                               std::chrono::duration<double>(options.for_s > 0.0 ? options.for_s : 1e6));
  std::uint64_t sent = 0;
  for (auto next = start; next < end && sleep_until(next) && (options.count == 0 || sent < options.count);) {
    if (sent > 0) bytes = encoded(publisher, message);  // with a new number, where the topic has numbers
    publisher.write(bytes);
    ++sent;
    next += period;
  }
  static_cast<void>(publisher.flush(kFlush));
  fmt::print("published {} on {}\n", counted(sent, "message"), options.topic);
  return exit_status::kOk;
}

void add_pub_options(CLI::App& app, ViewOptions& view, PubOptions& pub) {
  app.add_option("TOPIC", pub.topic, "name of the topic")->required();
  app.add_option("MESSAGE", pub.message, "the fields that are not zero, as JSON or YAML (default: none)");
  app.add_option("--file", pub.file, "read the message from this file; -: from the standard input")
      ->excludes("MESSAGE");
  app.add_option("--type", pub.type, "type of a topic that has no reader or writer yet, for example JointState");
  app.add_option("--rate", pub.rate_hz, "[Hz] publish again and again (default: once)")->check(number(1e-3, 1e4, "Hz"));
  app.add_option("--count,-n", pub.count, "with --rate, end after this many messages")->check(whole_number(1));
  app.add_option("--for", pub.for_s, "[s] with --rate, end after this time")->check(number(1e-3, 1e6, "s"));
  app.add_option("--wait", pub.wait_s, "[s] wait for a reader of the topic; 0: do not wait")
      ->capture_default_str()
      ->check(number(0, 1e6, "s"));
  app.add_flag("--check", pub.check, "check the message, print what would be sent, and send nothing");
  app.get_option("--count")->needs("--rate");
  app.get_option("--for")->needs("--rate");
  add_view_options(app, view);
  add_token_option(app);
  app.footer(help_footer(
      "The message is checked against the type: names of fields, ranges, names of constants. Fields that it leaves out "
      "are\nzero. On request/v2, run_control/v2 and emergency_stop, by which clients command a run, source, token, run "
      "id and numbers\nare filled in; `input`, the conductor and the plant check them as those of every other client. "
      "Authority ends with this\ncommand, unless the request has `detached: true`. All other topics of a run belong to "
      "its members and are refused while\na run is in the domain.",
      {"constrictor topic pub request/v2 '{level: operator, kind: motion, motion: stand}'",
       "constrictor topic pub run_control/v2 '{\"command\": \"pause\"}'",
       "constrictor topic pub rt/cmd_vel '{linear: {x: 0.3}}' --rate 10 --for 2   # beside ros_bridge",
       "constrictor topic pub joint_state '{joint_count: 2}' --check --run 9"},
      "0 published, or --check found no fault; 1 the topic has no reader; 64 the message does not fit the type;\n"
      "  70 no such topic, or it belongs to a run",
      kDomainEnvironment));
}

}  // namespace constrictor::cli
