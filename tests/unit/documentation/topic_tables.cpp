#include "topic_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "component/data_path.hpp"
#include "constrictor/topics.hpp"
#include "host/known_components.hpp"

namespace constrictor::documentation {
namespace {

struct SilentSink : MemberSink {
  void publish(const TopicInfo&, const Sample&) override {}
  void done(const TickDone&) override {}
};

std::string member_table() {
  std::string table =
      "| id | topic | type | writer | readers | rate | most per step | depth | content |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& topic : topics::kInfos) {
    const auto readers = readers_of(topic);
    table +=
        fmt::format("| {} | `{}` | `{}` | {} | {} | {} | {} | {} | {}{} |\n", topic.id, topic.name, topic.type,
                    topic.writer, readers.empty() ? "none" : fmt::format("{}", fmt::join(readers, ", ")), topic.rate,
                    topic.max_per_tick, topic.depth, topic.doc, topic.simulation_only ? " (simulation only)" : "");
  }
  return table;
}

std::string uncounted_table() {
  std::string table =
      "| topic | type | writers | readers | rate | depth | content |\n"
      "|---|---|---|---|---|---|---|\n";
  for (const auto& topic : barrier_topics::kInfos) {
    table += fmt::format("| `{}` | `{}` | {} | {} | {} | {} | {} |\n", topic.name, topic.type, topic.writers,
                         topic.readers, topic.rate, topic.depth, topic.doc);
  }
  return table;
}

/// `text` with what stands between the two markers of `name` replaced.
std::string replaced(const std::string& text, const std::string& name, const std::string& table) {
  const std::string begin = "<!-- " + name + ": made by the target topic_tables -->\n";
  const std::string end = "<!-- end of " + name + " -->\n";
  const auto from = text.find(begin);
  const auto to = text.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from) {
    throw std::runtime_error("found no lines \"" + begin.substr(0, begin.size() - 1) + "\" and \"" +
                             end.substr(0, end.size() - 1) + "\" around the table");
  }
  return text.substr(0, from + begin.size()) + "\n" + table + "\n" + text.substr(to);
}

}  // namespace

const std::map<std::string, std::unique_ptr<const Member>>& members() {
  static const auto all = [] {
    static SilentSink sink;
    Setup setup;
    // A robot with all sensors: the components read and write the topics of further cameras only if there are some.
    setup.robot_file = data_path("components/lib/robot/mamba_two_cameras.yaml");
    setup.scenario_file = data_path("sim/scenarios/case_study.yaml");
    setup.mission = "{sequence: [green, red], line_colour: blue}";
    std::map<std::string, std::unique_ptr<const Member>> made;
    for (const auto& [name, factory] : known_components()) {
      // They take the place of physics: the tables name one plant.
      if (name == "servo_bus" || name == "plant_relay") continue;
      made.emplace(name, std::make_unique<const Member>(factory(), setup, 1, false, sink));
    }
    return made;
  }();
  return all;
}

std::set<std::string> readers_of(const TopicInfo& topic) {
  std::set<std::string> readers;
  for (const auto& [name, member] : members()) {
    if (member->reads().contains(topic.id)) readers.insert(name);
  }
  return readers;
}

std::string with_topic_tables(const std::string& readme) {
  return replaced(replaced(readme, "member topics", member_table()), "barrier and client topics", uncounted_table());
}

}  // namespace constrictor::documentation
