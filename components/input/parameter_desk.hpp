// Rules on changes of run-time parameters: does the parameter exist, does it accept the value, is its tick still to come. Pure.
#pragma once

#include <cereal/types/vector.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

struct ParameterDeskState {
  std::vector<std::int64_t> waiting;  ///< ticks of the accepted changes that are still to come, in no order
  template <class Archive>
  void serialize(Archive& archive) {
    archive(waiting);
  }
};

/// A change asked for beforehand, by input.yaml.
struct PlannedChange {
  std::int64_t tick = 0;
  std::string name;
  double value = 0.0;
};

/// `parameter_changes` of input.yaml, in the order of their ticks; those of one tick as in the file. Throws ConfigurationError.
std::vector<PlannedChange> load_planned_changes(const std::filesystem::path& file);

class ParameterDesk {
 public:
  explicit ParameterDesk(ParameterDeskState& state) : state_(state) {}

  /// The change that a request of kind "parameter" leads to at tick `now`, or why it leads to none. `lists`: what the owners
  /// announced; null where one has not yet. A change takes effect at the next tick at the earliest: what is written now is visible then.
  std::variant<msg::ParameterChange, std::string> rule(const msg::Request& request, const std::vector<const msg::ParameterList*>& lists,
                                                       std::int64_t now);

 private:
  ParameterDeskState& state_;
};

}  // namespace constrictor
