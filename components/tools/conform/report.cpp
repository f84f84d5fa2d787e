#include "conform/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace constrictor::conform {
namespace {

const char* word_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPassed:
      return "pass";
    case Verdict::kFailed:
      return "fail";
    case Verdict::kSkipped:
      return "skipped";
    case Verdict::kNotChecked:
      break;
  }
  return "not checked";
}

}  // namespace

Report::Report(std::vector<Check> checks, std::function<void(const Check&)> line)
    : checks_(std::move(checks)), line_(std::move(line)) {}

const Check& Report::check(const std::string& name) const {
  const auto found = std::find_if(checks_.begin(), checks_.end(), [&](const Check& c) { return c.name == name; });
  if (found == checks_.end()) throw std::logic_error("conform: no check is named " + name);
  return *found;
}

void Report::set(const std::string& name, Verdict verdict, const std::string& found, const std::string& todo) {
  Check& one = checks_.at(static_cast<std::size_t>(&check(name) - checks_.data()));
  one.verdict = verdict;
  one.found = found;
  one.todo = todo;
  if (line_) line_(one);
}

void Report::pass(const std::string& name, const std::string& found) { set(name, Verdict::kPassed, found, {}); }
void Report::fail(const std::string& name, const std::string& found, const std::string& todo) {
  set(name, Verdict::kFailed, found, todo);
}
void Report::skip(const std::string& name, const std::string& reason) { set(name, Verdict::kSkipped, reason, {}); }
void Report::skip_rest(const std::string& reason) {
  for (std::size_t i = 0; i < checks_.size(); ++i) {
    if (checks_[i].verdict == Verdict::kNotChecked) skip(checks_[i].name, reason);
  }
}

std::size_t Report::count(Verdict verdict) const {
  return static_cast<std::size_t>(
      std::count_if(checks_.begin(), checks_.end(), [&](const Check& c) { return c.verdict == verdict; }));
}

std::string text_of(const Check& check) {
  std::string text = fmt::format("{:<12} {:<16} {}", word_of(check.verdict), check.name, check.found);
  if (check.verdict != Verdict::kFailed) return text;
  return text + fmt::format("\n{:<29} expected: {}\n{:<29} to do: {}", "", check.expected, "", check.todo);
}

std::string summary_of(const Report& report) {
  std::string text =
      fmt::format("{} passed, {} failed, {} skipped, {} not checked", report.count(Verdict::kPassed),
                  report.count(Verdict::kFailed), report.count(Verdict::kSkipped), report.count(Verdict::kNotChecked));
  std::string open;
  for (const auto& one : report.checks()) {
    if (one.verdict == Verdict::kNotChecked) open += (open.empty() ? "" : ", ") + one.name;
  }
  return open.empty() ? text : text + "\nnot checked: " + open;
}

nlohmann::ordered_json to_json(const Report& report) {
  nlohmann::ordered_json json = {{"conforms", report.conforms()}, {"checks", nlohmann::ordered_json::array()}};
  for (const auto& one : report.checks()) {
    json["checks"].push_back({{"name", one.name},
                              {"result", word_of(one.verdict)},
                              {"found", one.found},
                              {"expected", one.expected},
                              {"to_do", one.todo}});
  }
  return json;
}

}  // namespace constrictor::conform
