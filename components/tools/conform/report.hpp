// The results of a conformance run: one line for each check, for people and as JSON.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace constrictor::conform {

enum class Verdict { kNotChecked, kPassed, kFailed, kSkipped };

struct Check {
  std::string name;
  std::string expected;  ///< the contract in words
  Verdict verdict = Verdict::kNotChecked;
  std::string found;  ///< what was measured, or why the check was skipped
  std::string todo;   ///< what to do after a failure
};

class Report {
 public:
  /// `checks`: all checks, in the order in which they are shown. A check without a result is shown as "not checked".
  /// Calls `line` with each result as soon as it is known.
  explicit Report(std::vector<Check> checks, std::function<void(const Check&)> line = {});

  void pass(const std::string& name, const std::string& found);
  void fail(const std::string& name, const std::string& found, const std::string& todo);
  void skip(const std::string& name, const std::string& reason);
  /// Skips every check that has no result yet.
  void skip_rest(const std::string& reason);
  /// fail() if `failed`, pass() if not.
  void judge(const std::string& name, bool failed, const std::string& found, const std::string& todo) {
    if (failed) fail(name, found, todo);
    else pass(name, found);
  }
  /// pass() with `right` if `wrong` is empty, fail() with what was wrong if not.
  void pass_unless(const std::string& name, const std::string& wrong, const std::string& right,
                   const std::string& todo) {
    judge(name, !wrong.empty(), wrong.empty() ? right : wrong, todo);
  }

  [[nodiscard]] const std::vector<Check>& checks() const { return checks_; }
  [[nodiscard]] const Check& check(const std::string& name) const;
  [[nodiscard]] bool failed(const std::string& name) const { return check(name).verdict == Verdict::kFailed; }
  [[nodiscard]] std::size_t count(Verdict verdict) const;
  /// Every check has a result, and none failed.
  [[nodiscard]] bool conforms() const { return count(Verdict::kFailed) == 0 && count(Verdict::kNotChecked) == 0; }

 private:
  void set(const std::string& name, Verdict verdict, const std::string& found, const std::string& todo);
  std::vector<Check> checks_;
  std::function<void(const Check&)> line_;
};

/// "pass  sign      joints 0 to 22 ...", and for a failure what was expected and what to do.
[[nodiscard]] std::string text_of(const Check& check);
[[nodiscard]] std::string summary_of(const Report& report);
[[nodiscard]] nlohmann::ordered_json to_json(const Report& report);

}  // namespace constrictor::conform
