#include "cli/evaluate/result_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace constrictor::cli {
namespace {

struct TableColumn {
  std::string heading;
  std::function<std::string(const VariantSummary&)> value;
  bool only_if_any = false;  ///< the column is left out if all its values are 0
};

std::string known(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

std::string interval_text(const VariantSummary& summary) {
  const Interval interval = wilson_interval(summary.successes(), summary.begun());
  return fmt::format("{:.0f} to {:.0f} %", 100 * interval.low, 100 * interval.high);
}

std::vector<TableColumn> table_columns() {
  using Summary = VariantSummary;
  return {{"runs", [](const Summary& s) { return fmt::to_string(s.runs); }},
          {"succeeded", [](const Summary& s) { return fmt::to_string(s.successes()); }},
          {"95 %", interval_text},
          {"not true", [](const Summary& s) { return fmt::to_string(s.false_successes); }, true},
          {"unnoticed", [](const Summary& s) { return fmt::to_string(s.unnoticed_successes); }, true},
          {"errors", [](const Summary& s) { return fmt::to_string(s.errors); }, true},
          {"refused", [](const Summary& s) { return fmt::to_string(s.refused); }, true},
          {"time", [](const Summary& s) { return known(s.mission_time_s.at(0.5), 1); }},
          {"place", [](const Summary& s) { return known(s.placement_m.at(0.5), 3); }},
          {"recoveries", [](const Summary& s) { return known(s.recoveries.at(0.5), 1); }},
          {"longest", [](const Summary& s) { return known(s.worst_recovery.duration_s, 1); }}};
}

/// The summary with the longest recovery; null if no run had one.
const VariantSummary* worst_of(const std::vector<VariantSummary>& summaries) {
  const VariantSummary* worst = nullptr;
  for (const auto& summary : summaries) {
    if (!std::isfinite(summary.worst_recovery.duration_s)) continue;
    if (!worst || summary.worst_recovery.duration_s > worst->worst_recovery.duration_s) worst = &summary;
  }
  return worst;
}

}  // namespace

std::string to_table(const std::vector<VariantSummary>& summaries, std::size_t columns) {
  constexpr const char* kVariant = "variant";
  constexpr std::size_t kGap = 2;  // blanks between columns
  std::size_t name_width = std::char_traits<char>::length(kVariant), width = 0;
  for (const auto& summary : summaries) name_width = std::max(name_width, summary.name.size());
  std::string heading;
  std::vector<std::string> rows(summaries.size());
  bool some_untrue = false, some_unnoticed = false;
  for (const TableColumn& column : table_columns()) {
    std::vector<std::string> values;
    for (const auto& summary : summaries) values.push_back(column.value(summary));
    const auto is_zero = [](const std::string& value) { return value == "0"; };
    if (column.only_if_any && std::all_of(values.begin(), values.end(), is_zero)) continue;
    some_untrue = some_untrue || column.heading == "not true";
    some_unnoticed = some_unnoticed || column.heading == "unnoticed";
    std::size_t cell = column.heading.size();
    for (const auto& value : values) cell = std::max(cell, value.size());
    heading += fmt::format("{:>{}}", column.heading, cell + kGap);
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] += fmt::format("{:>{}}", values[i], cell + kGap);
    width += cell + kGap;
  }

  const bool beside = name_width + width <= columns;
  std::string text = beside ? fmt::format("{:<{}}{}\n", kVariant, name_width, heading) : heading + "\n";
  for (std::size_t i = 0; i < rows.size(); ++i)
    text += beside ? fmt::format("{:<{}}{}\n", summaries[i].name, name_width, rows[i])
                   : fmt::format("{}\n{}\n", summaries[i].name, rows[i]);
  text +=
      "(95 %: interval of the share that succeeds; time: median of successful missions\n"
      "[s]; place: median distance of dropped objects from their zone's centre [m];\n"
      "recoveries: median; longest: the longest recovery of all runs [s])\n";
  if (some_untrue)
    text +=
        "(not true: missions that the robot believed to have succeeded, and that had not;\n"
        "index.html names them)\n";
  if (some_unnoticed)
    text +=
        "(unnoticed: missions that ended without success although all objects lie in their\n"
        "zones; index.html names them)\n";
  const VariantSummary* worst = worst_of(summaries);
  if (!worst) return text;
  return text + fmt::format("longest recovery: {:.1f} s, seed {}{}, {:.1f} s after the start, {}\n",
                            worst->worst_recovery.duration_s, worst->worst_seed,
                            summaries.size() > 1 ? " with " + worst->name : "", worst->worst_recovery.begin_s,
                            worst->worst_recovery.cause);
}

}  // namespace constrictor::cli
