// Decides on changes of run-time parameters: whether the parameter exists, accepts the value, and the tick is still to
// come. It contains no DDS code.
#pragma once

#include <cereal/types/vector.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

struct ParameterArbiterState {
  std::vector<std::int64_t> waiting;  ///< ticks of the accepted changes that are still to come, unordered
  template <class Archive>
  void serialize(Archive& archive) {
    archive(waiting);
  }
};

/// A change that input.yaml requests.
struct PlannedChange {
  std::int64_t tick = 0;
  std::string name;
  double value = 0.0;
};

/// `parameter_changes` of input.yaml, sorted by tick; changes of one tick in the order of the file. Throws
/// ConfigurationError.
std::vector<PlannedChange> load_planned_changes(const std::filesystem::path& file);

class ParameterArbiter {
 public:
  explicit ParameterArbiter(ParameterArbiterState& state) : state_(state) {}

  /// The change for a request of kind "parameter" at tick `now`, or the reason of its refusal. `lists`: the announced
  /// parameters of each owner, null before its first announcement. A change takes effect at the next tick or later,
  /// because a message that is written now becomes visible then.
  std::variant<msg::ParameterChange, std::string> decide(const msg::Request& request,
                                                         const std::vector<const msg::ParameterList*>& lists,
                                                         std::int64_t now);

 private:
  ParameterArbiterState& state_;
};

}  // namespace constrictor
