#include "bench/validation/results.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "sim/figure/png.hpp"

namespace constrictor::validation {
namespace {

void write_file(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream stream(file, std::ios::binary);
  stream << bytes;
  stream.close();
  if (!stream) throw std::runtime_error("cannot write " + file.string() + ": is there space, and may this user write?");
}

std::string row_of(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += " " + cell + " |";
  return row + "\n";
}

std::string error_of(const Case& one) {
  return one.relative ? fmt::format("{:.2f} %", 100.0 * one.error()) : shown(one.error());
}

std::string limit_of(const Case& one) {
  return one.relative ? fmt::format("{:g} %", 100.0 * one.limit) : shown(one.limit);
}

std::string verdict_of(const Case& one) {
  if (one.passed()) return "yes";
  return one.required ? "**no**" : "no (aim)";
}

}  // namespace

double Case::error() const {
  const double difference = std::abs(found - expected);
  return relative ? difference / std::abs(expected) : difference;
}

bool Case::passed() const { return std::isfinite(found) && error() <= limit; }

std::string shown(double value) { return fmt::format("{:.4g}", value); }

int Results::required_misses() const {
  int misses = 0;
  for (const Section& section : sections_) {
    for (const Case& one : section.cases) misses += one.required && !one.passed() ? 1 : 0;
  }
  return misses;
}

int Results::missed_aims() const {
  int misses = 0;
  for (const Section& section : sections_) {
    for (const Case& one : section.cases) misses += !one.required && !one.passed() ? 1 : 0;
  }
  return misses;
}

std::string Results::markdown() const {
  std::size_t count = 0;
  for (const Section& section : sections_) count += section.cases.size();
  std::string page = "# Validation of the physics\n\n";
  page += fmt::format("{} comparisons; {} miss their limit, {} more miss their aim.\n", count, required_misses(),
                      missed_aims());
  for (const Section& section : sections_) {
    page += "\n## " + section.title + "\n\n" + section.text + "\n";
    if (!section.cases.empty()) {
      page += "\n| case | unit | expected | found | error | limit | pass |\n|---|---|---|---|---|---|---|\n";
      for (const Case& one : section.cases) {
        page += row_of(
            {one.name, one.unit, shown(one.expected), shown(one.found), error_of(one), limit_of(one), verdict_of(one)});
      }
    }
    for (const Table& table : section.tables) {
      page += "\n" + table.caption + "\n\n" + row_of(table.columns);
      page += row_of(std::vector<std::string>(table.columns.size(), "---"));
      for (const auto& row : table.rows) page += row_of(row);
    }
    for (const Figure& figure : section.figures) page += "\n![" + figure.title + "](" + figure.file + ")\n";
  }
  return page;
}

nlohmann::json Results::json() const {
  nlohmann::json all = {{"required_misses", required_misses()}, {"missed_aims", missed_aims()}};
  all["sections"] = nlohmann::json::array();
  for (const Section& section : sections_) {
    nlohmann::json entry = {{"title", section.title}, {"text", section.text}};
    entry["cases"] = nlohmann::json::array();
    for (const Case& one : section.cases) {
      entry["cases"].push_back({{"name", one.name},
                                {"unit", one.unit},
                                {"expected", one.expected},
                                {"found", one.found},
                                {"error", one.error()},
                                {"limit", one.limit},
                                {"relative", one.relative},
                                {"required", one.required},
                                {"passed", one.passed()}});
    }
    entry["tables"] = nlohmann::json::array();
    for (const Table& table : section.tables)
      entry["tables"].push_back({{"caption", table.caption}, {"columns", table.columns}, {"rows", table.rows}});
    entry["figures"] = nlohmann::json::array();
    for (const Figure& figure : section.figures) {
      nlohmann::json panels = nlohmann::json::array();
      for (const Plot& plot : figure.plots) {
        nlohmann::json series = nlohmann::json::array();
        for (const Series& one : plot.series) series.push_back({{"name", one.name}, {"x", one.x}, {"y", one.y}});
        panels.push_back({{"x", plot.x_label}, {"y", plot.y_label}, {"series", series}});
      }
      entry["figures"].push_back({{"title", figure.title}, {"file", figure.file}, {"panels", panels}});
    }
    all["sections"].push_back(entry);
  }
  return all;
}

void Results::write(const std::filesystem::path& folder) const {
  std::filesystem::create_directories(folder);
  write_file(folder / "validation.md", markdown());
  write_file(folder / "validation.json", json().dump(2) + "\n");
  for (const Section& section : sections_) {
    for (const Figure& figure : section.figures) {
      const cv::Mat rgb = draw(figure);
      write_file(folder / figure.file, constrictor::encode_png(rgb.cols, rgb.rows, rgb.data));
    }
  }
}

}  // namespace constrictor::validation
