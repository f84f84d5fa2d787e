// A run from the installed prefix, an example beside it, and what the test itself reads of both over DDS.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {

inline std::string example(const std::string& name) {
  return std::string(CONSTRICTOR_EXAMPLES) + "/" + name + "/" + name;
}

/// Reads authority and goals over DDS.
struct Witness {
  explicit Witness(unsigned domain)
      : here(domain),
        authority_reader(dds::Reader<msg::Authority>::member(here.participant(), "authority")),
        event_reader(dds::Reader<msg::TaskEvent>::member(here.participant(), "task/event")) {}
  /// Reads until `condition` holds; false if it does not within the bound.
  template <class Condition>
  bool until(Condition condition, std::chrono::seconds bound) {
    return eventually(
        [&] {
          authority_reader.take([this](const msg::Authority& now) { authority = now; });
          event_reader.take([this](const msg::TaskEvent& event) { events.push_back(event); });
          return condition();
        },
        bound);
  }
  /// Whether a process of this program (its source is PROGRAM.PID) has authority.
  [[nodiscard]] bool holds(const std::string& program) const {
    return authority.level == msg::kAuthorityExternal && std::string(authority.source).rfind(program + ".", 0) == 0;
  }
  /// Whether an external planner's goal of this task had this event.
  [[nodiscard]] bool happened(std::uint8_t task, std::uint8_t event) const {
    return std::any_of(events.begin(), events.end(), [&](const msg::TaskEvent& e) {
      return e.goal_id >> 48 == msg::kAuthorityExternal && e.task == task && e.event == event;
    });
  }

  dds::Domain here;
  dds::Reader<msg::Authority> authority_reader;
  dds::Reader<msg::TaskEvent> event_reader;
  msg::Authority authority{};
  std::vector<msg::TaskEvent> events;
};

class ExampleRun : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(dir_ / name) << text; }
  /// A copy of an installed configuration with one text replaced.
  [[nodiscard]] std::string altered(const std::string& file, const std::string& what, const std::string& with) const {
    std::ifstream stream(std::string(CONSTRICTOR_PREFIX) + "/share/constrictor/" + file);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    const auto at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what << " in " << file;
    if (at != std::string::npos) text.replace(at, what.size(), with);
    const auto path = dir_ / std::filesystem::path(file).filename();
    std::ofstream(path) << text;
    return path.string();
  }
  [[nodiscard]] Process run(const std::string& scenario, std::vector<std::string> more) const {
    std::vector<std::string> arguments = {std::string(CONSTRICTOR_PREFIX) + "/bin/constrictor", "run", scenario,
                                          "--report", (dir_ / "r").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Process(std::move(arguments));
  }
  [[nodiscard]] nlohmann::json report() const {
    return nlohmann::json::parse(std::ifstream(dir_ / "r/report.json"), nullptr, false);
  }

  const TemporaryFolder folder_;
  const std::filesystem::path dir_ = folder_.path();
};

}  // namespace constrictor::testing
