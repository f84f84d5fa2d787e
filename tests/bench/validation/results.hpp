// What the validation has found: cases with an independent value, tables and plots, and the files made from them.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/validation/plot.hpp"

namespace constrictor::validation {

/// One comparison of the simulation with an independent value.
struct Case {
  std::string name;
  std::string unit;
  double expected = 0.0;
  double found = 0.0;
  double limit = 0.01;
  bool relative = true;  ///< `limit` is a share of `expected`; otherwise it has the unit of `expected`
  bool required = true;  ///< false: an aim; a miss is shown, but does not make the program fail

  /// Difference of `found` and `expected`, as a share if `relative`.
  [[nodiscard]] double error() const;
  [[nodiscard]] bool passed() const;  ///< false also if `found` is not finite
};

/// Measured values without an independent value to compare with.
struct Table {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// The results of one group of checks. `text` explains in one paragraph what was compared with what.
struct Section {
  std::string title;
  std::string text;
  std::vector<Case> cases;
  std::vector<Table> tables;
  std::vector<Figure> figures;
};

class Results {
 public:
  void add(Section section) { sections_.push_back(std::move(section)); }
  [[nodiscard]] int required_misses() const;
  [[nodiscard]] int missed_aims() const;
  /// Writes validation.json, validation.md and the figures as PNG files into a folder, which it makes if necessary.
  /// Throws std::runtime_error, which names the file, if one cannot be written.
  void write(const std::filesystem::path& folder) const;

 private:
  [[nodiscard]] std::string markdown() const;
  [[nodiscard]] nlohmann::json json() const;

  std::vector<Section> sections_;
};

/// A number with as many digits as a reader needs: 4 significant ones.
[[nodiscard]] std::string shown(double value);

}  // namespace constrictor::validation
