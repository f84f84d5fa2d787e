// The error of a command that could not be carried out.
#pragma once

#include <stdexcept>
#include <string>

namespace constrictor {

/// A command to a run failed. The message names the object, what happened and what to do.
class CommandError : public std::runtime_error {
 public:
  enum class Cause {
    kNoRun,        ///< no run was found, or several and none was chosen
    kRefused,      ///< the run refused the command
    kNoAnswer,     ///< no answer came within the bound
    kInterrupted,  ///< the caller's `interrupted` function returned true while the command waited
    kFailed,       ///< anything else
  };
  explicit CommandError(const std::string& message, Cause cause = Cause::kFailed)
      : std::runtime_error(message), cause_(cause) {}
  [[nodiscard]] Cause cause() const { return cause_; }

 private:
  Cause cause_;
};

}  // namespace constrictor
