// What the benchmarks wrote into a folder, and the table and the JSON that are made of it.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace constrictor::bench {

class Results {
 public:
  explicit Results(std::filesystem::path folder);

  /// The CPU time of one execution [ms] by the name of the benchmark; the median, if it was repeated.
  [[nodiscard]] const std::map<std::string, double>& times_ms() const { return times_ms_; }
  /// The times of the benchmarks whose names begin with `group` and a slash, by what follows up to the next slash.
  [[nodiscard]] std::map<std::string, double> group_ms(const std::string& group) const;
  /// The benchmarks that could not measure, with their messages.
  [[nodiscard]] const std::map<std::string, std::string>& errors() const { return errors_; }
  /// The content of a JSON file of the folder; not an object if there is none or it is damaged.
  [[nodiscard]] nlohmann::json file(const std::string& name) const;
  /// The results of a file of Google Benchmark; none if there is no such file.
  [[nodiscard]] std::vector<nlohmann::json> benchmarks(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  std::map<std::string, double> times_ms_;
  std::map<std::string, std::string> errors_;
};

/// The parts of the table append their text and numbers. `within` becomes false if one of them exceeds its limit.
struct Table {
  nlohmann::json all;
  std::string text;
  bool within = true;

  /// The last cell of a row that has a limit.
  [[nodiscard]] const char* verdict(bool excess) {
    within = within && !excess;
    return excess ? "EXCEEDED" : "";
  }
  /// What could not be measured or compared counts as exceeded.
  void fail(const std::string& name, const std::string& message) {
    within = false;
    all["errors"][name] = message;
    text += fmt::format("\nEXCEEDED: {} could not be measured: {}\n", name, message);
  }
};

// case_study.cpp
void add_case_study(const Results& results, Table& table);
void add_launch(const Results& results, Table& table);
void add_function_groups(const Results& results, Table& table);
// growth.cpp
void add_growth(const Results& results, Table& table);
// parts.cpp
void add_tick_parts(const Results& results, Table& table);
void add_camera_passes(const Results& results, Table& table);
// peers.cpp
void add_ddsperf(const Results& results, Table& table);
void add_engines(const Results& results, Table& table);
void add_renderers(const Results& results, Table& table);

}  // namespace constrictor::bench
