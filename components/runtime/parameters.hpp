// Run-time parameters: values of a component's configuration that may change while it runs, at a named tick. The changes come
// through `input` and the barrier like everything else, so a run with the same changes at the same ticks is the same run.
#pragma once

#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/component.hpp"

namespace constrictor {

/// What a component remembers of its parameters. A part of its state.
struct ParameterState {
  struct Change {
    std::string name;
    double value = 0.0;
    std::int64_t tick = 0;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(name, value, tick);
    }
  };
  std::vector<Change> in_force;  ///< of each parameter that was changed the newest value, and the tick since when
  std::vector<Change> waiting;   ///< for their tick: the earliest first, one of each parameter for a tick
  bool announced = false;        ///< the list was written in this epoch
  template <class Archive>
  void serialize(Archive& archive) {
    archive(in_force, waiting, announced);
  }
};

/// Accepted values, both ends included.
struct ParameterBounds {
  double min = 0.0;
  double max = 0.0;
};

/// Empty if a parameter accepts the value, otherwise what was found and what is accepted.
std::string parameter_refusal(const msg::Parameter& parameter, double value);

/// The table of a component's run-time parameters, each bound to the field of its configuration that it sets. A component has one
/// as a member, fills it when it is built, and calls `step` before anything else in its own step:
///
///     if (parameters_.step(tick, state_.parameters)) rebuild_what_keeps_a_copy_of(config_);
class Parameters {
 public:
  /// `topic` is where the list is written; its writer is the owner, whose name begins the parameters' names.
  Parameters(Wiring& wiring, const Topic<msg::ParameterList>& topic);
  Parameters(const Parameters&) = delete;
  Parameters& operator=(const Parameters&) = delete;

  /// Adds a row. `key`: keys of the configuration file, joined by dots. `field` must outlive this object; what it holds now is the
  /// default. `unit`: as people write it, or empty. `doc`: one line. Throws std::logic_error if the row cannot be.
  void add(double& field, std::string_view key, std::string_view unit, ParameterBounds bounds, std::string_view doc);
  void add(int& field, std::string_view key, std::string_view unit, ParameterBounds bounds, std::string_view doc);

  /// Takes in the changes that became visible, puts those into force whose tick has come, and writes the list when something in it
  /// changed. Returns true if a field has another value than before: also at the first step after load(). A change that is not of
  /// this component is none of its business; one of an unknown name or value is refused and counted.
  bool step(const Tick& tick, ParameterState& state);

  /// What would be written now.
  [[nodiscard]] msg::ParameterList list(const ParameterState& state) const;

 private:
  struct Row {
    msg::Parameter facts{};      ///< what never changes
    double* real = nullptr;      ///< the field: this one,
    int* whole = nullptr;        ///< or this one
  };
  void add(Row row, std::string_view key, std::string_view unit, ParameterBounds bounds, std::string_view doc);
  bool take_in(const msg::ParameterChange& change, ParameterState& state);
  bool set_fields(const ParameterState& state);

  Wiring& wiring_;
  std::string owner_;
  Events<msg::ParameterChange> changes_;
  Output<msg::ParameterList> list_;
  std::vector<Row> rows_;        ///< by name
  bool fields_set_ = false;      ///< the fields are what the state says
};

}  // namespace constrictor
