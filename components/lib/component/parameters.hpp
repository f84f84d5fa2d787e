// Run-time parameters: values of a component's configuration that may change during a run, each at a named tick. The
// changes come from `input` through the barrier, like every other message. Two runs with the same changes at the same
// ticks are therefore identical.
#pragma once

#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "component/component.hpp"
#include "configuration/parameter_set.hpp"

namespace constrictor {

/// The run-time parameters of a component, as a part of its state.
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
  std::vector<Change>
      in_force;  ///< the newest value of each changed parameter, and the tick at which it came into force
  std::vector<Change> waiting;  ///< changes for later ticks, by tick; at most one for each parameter and tick
  bool announced = false;       ///< the list has been written in this epoch
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

/// The names of the values 0, 1, 2, ... of a parameter that is chosen by name; empty for a number.
std::vector<std::string> choices_of(const msg::Parameter& parameter);

/// Empty if the parameter accepts the value. Otherwise: what was found and what is accepted.
std::string parameter_refusal(const msg::Parameter& parameter, double value);

/// The run-time parameters of a component: the rows of its configuration that may change during a run. A component has
/// one as a member and calls `step` before anything else in its own step:
///
///     if (parameters_.step(tick, state_.parameters)) rebuild_what_keeps_a_copy_of(config_);
class Parameters {
 public:
  /// `topic` is the topic on which the list is published. Its writer is the owner; the owner's name is the first part
  /// of the parameters' names.
  Parameters(Wiring& wiring, const Topic<msg::ParameterList>& topic);
  /// The same, with every row of `config` that may change while the component runs. The value that a field holds now is
  /// its default in this run. `config` must outlive this object and must not move.
  Parameters(Wiring& wiring, const Topic<msg::ParameterList>& topic, ParameterSet& config);
  Parameters(const Parameters&) = delete;
  Parameters& operator=(const Parameters&) = delete;

  /// Adds one parameter by hand. `key`: keys of the configuration file, joined by dots. `field` must outlive this
  /// object; the value that it holds now is the default. `unit`: as people write it, or empty. `doc`: one line of at
  /// most 95 characters. Throws std::logic_error if the row contradicts itself.
  void add(double& field, std::string_view key, std::string_view unit, ParameterBounds bounds, std::string_view doc);
  void add(int& field, std::string_view key, std::string_view unit, ParameterBounds bounds, std::string_view doc);

  /// Takes the changes that became visible, applies those whose tick has come, and publishes the list if anything in it
  /// changed. Returns true if a field has another value than before this call, which is also possible at the first step
  /// after load(). Changes of other components' parameters are ignored. A change with an unknown name or a rejected
  /// value is dropped and counted as a refusal.
  bool step(const Tick& tick, ParameterState& state);

  /// The list as it would be published now.
  [[nodiscard]] msg::ParameterList list(const ParameterState& state) const;

 private:
  struct Row {
    msg::Parameter facts{};  ///< name, unit, bounds, default, meaning
    void* field = nullptr;
    double (*get)(const void* field) = nullptr;
    void (*set)(void* field, double value) = nullptr;
  };
  template <class Number>
  void add_field(Number& field, std::string_view key, std::string_view unit, ParameterBounds bounds,
                 std::string_view doc);
  void add(Row row, std::string_view key, std::string_view unit, ParameterBounds bounds, std::string_view doc);
  bool take_in(const msg::ParameterChange& change, ParameterState& state);
  bool set_fields(const ParameterState& state);

  Wiring& wiring_;
  std::string owner_;
  Events<msg::ParameterChange> changes_;
  Output<msg::ParameterList> list_;
  std::vector<Row> rows_;    ///< sorted by name
  bool fields_set_ = false;  ///< the fields hold the values of the state
};

/// A component whose configuration has rows that may change during a run. `State` has a member `parameters`, a
/// ParameterState. The component's step begins with `parameters_.step(tick, state_.parameters)`.
template <class State, class Config>
class TunableComponent : public ConfiguredComponent<State, Config> {
 protected:
  /// Reads the configuration; `topic`: where the list of parameters is published. Throws ConfigurationError.
  TunableComponent(Wiring& wiring, const Setup& setup, const Topic<msg::ParameterList>& topic)
      : TunableComponent(wiring, load_configuration<Config>(setup), topic) {}
  TunableComponent(Wiring& wiring, Config config, const Topic<msg::ParameterList>& topic)
      : ConfiguredComponent<State, Config>(wiring, std::move(config)), parameters_(wiring, topic, this->config_) {}

  Parameters parameters_;  ///< the rows of config_
};

}  // namespace constrictor
