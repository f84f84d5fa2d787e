// Defines a component: a step function with declared ports and one serialisable state. Nothing here depends on DDS.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "component/mission.hpp"
#include "component/ports.hpp"
#include "component/stateful.hpp"
#include "configuration/parameter_set.hpp"
#include "log/log.hpp"

namespace constrictor {

/// The instant of a step. Time is an argument, never a call.
struct Tick {
  std::int64_t index = 0;      ///< control periods since the epoch began
  std::int64_t time_ns = 0;    ///< [ns] simulated or robot time
  std::int64_t period_ns = 0;  ///< [ns] control period
  std::int64_t elapsed = 1;    ///< ticks since this component's previous step (its period at the first)
  std::uint64_t run_id = 0;    ///< random name of the run; no result may depend on it
  std::uint32_t epoch = 0;

  [[nodiscard]] double time_s() const { return static_cast<double>(time_ns) * 1e-9; }
  /// [s] time over which this step integrates.
  [[nodiscard]] double dt_s() const { return static_cast<double>(elapsed * period_ns) * 1e-9; }
  /// [s] length of one tick.
  [[nodiscard]] double period_s() const { return static_cast<double>(period_ns) * 1e-9; }
};

inline constexpr std::uint16_t kLargestLatency_ticks = 100;

/// How often a component steps and when its outputs become visible, in ticks.
struct Timing {
  std::uint16_t period = 1;
  std::uint16_t latency = 1;
};

/// The inputs from which a component is built. All paths are absolute.
struct Setup {
  std::string component;                ///< name in the roster
  std::filesystem::path robot_file;     ///< YAML of components/lib/robot
  std::filesystem::path scenario_file;  ///< YAML of sim/scenarios; only sim/ may open it
  std::filesystem::path
      config_file;  ///< the component's own YAML; if empty, the runtime sets the default of the factory
  std::filesystem::path output_dir;  ///< for components that write files (report); may be empty
  std::string mission;               ///< YAML on one line, see mission.hpp; empty: the scenario states no mission
  double max_sim_time_s = 0.0;       ///< [s] simulated time at which the plant ends the run; 0: never
  std::uint64_t seed = 1;            ///< of the epoch
  std::uint16_t robot_id = 1;        ///< key of every message of this robot
  std::uint16_t latency_ticks = 1;   ///< least latency of the component; one with a longer latency of its own keeps it
  Log log;  ///< for what people must know, never once per tick; a step that is repeated after a restart logs again

  /// Seed of this component's own generator: a fixed mix of `seed` and `component`.
  [[nodiscard]] std::uint64_t component_seed() const;
};

/// A member of the barrier. Constructed anew at each epoch with its ports bound; `step` is called at each due tick with
/// every input that was visible then; what it writes becomes visible `latency` ticks later. It never sleeps, reads no
/// clock and draws random numbers only from generators seeded by Setup::component_seed() and kept in its state.
class Component {
 public:
  Component() = default;
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;
  virtual ~Component() = default;

  [[nodiscard]] virtual Timing timing() const { return {}; }
  /// Whether a step, and to build the component, always take a few milliseconds at most. Then the runtime may step in
  /// the thread that receives messages: that saves a switch between threads for each tick, but the process receives
  /// nothing during a step.
  [[nodiscard]] virtual bool has_short_steps() const { return false; }
  virtual void step(const Tick& tick) = 0;

  /// The whole state, such that load(save()) into a newly built component continues bit-identically.
  [[nodiscard]] virtual std::string save() const = 0;
  virtual void load(const std::string& bytes) = 0;
};

/// A component whose state is one cereal-serialisable struct.
template <class State>
using StatefulComponent = Stateful<Component, State>;

/// A component's configuration from its own file. If `Config` has a member `know(const PriorKnowledge&)`, it then takes
/// over what the mission states to be known beforehand. Throws ConfigurationError.
template <class Config>
[[nodiscard]] Config load_configuration(const Setup& setup) {
  auto config = load_parameters<Config>(setup.config_file);
  if constexpr (requires(const PriorKnowledge& known) { config.know(known); })
    config.know(prior_knowledge(setup.mission));
  return config;
}

/// A stateful component with a configuration file. Configuration and wiring are there before the members of the derived
/// class, which can therefore be initialised where they are declared:
///
///     Latest<msg::JointState> joints_ = wiring_.latest(topics::kJointState);
template <class State, class Config>
class ConfiguredComponent : public StatefulComponent<State> {
 protected:
  ConfiguredComponent(Wiring& wiring, Config config) : wiring_(wiring), config_(std::move(config)) {}
  /// Reads the configuration as load_configuration() does. Throws ConfigurationError.
  ConfiguredComponent(Wiring& wiring, const Setup& setup)
      : ConfiguredComponent(wiring, load_configuration<Config>(setup)) {}

  Wiring& wiring_;
  Config config_;
};

/// The plant: it owns the joints and therefore the time. At tick k, `sample` writes what is measured at t_k (visible in
/// tick k itself); then `step` applies the commands visible at k and advances to t_{k+1}. save() is called after
/// sample(); a plant that does not override it has no state that a restarted process would need.
class Plant : public Component {
 public:
  virtual void sample(const Tick& tick) = 0;
  [[nodiscard]] virtual std::int64_t period_ns() const = 0;
  [[nodiscard]] std::string save() const override { return {}; }
  void load(const std::string&) override {}
};

/// How the runtime makes a component: its name, its constructor, and the default for Setup::config_file, as a path for
/// data_path() (empty: the component has no configuration).
struct ComponentFactory {
  std::string name;
  std::function<std::unique_ptr<Component>(Wiring&, const Setup&)> create;
  std::filesystem::path default_config = {};
  /// Reads and checks a configuration file without building the component, and describes its parameters; null if the
  /// component has none. `describe_parameters<Config>` for a Config that is a ParameterSet.
  DescribeParameters parameters = nullptr;
};

/// The factory of a component that is constructed from its wiring and set-up, and whose parameters are a `Config`.
/// `default_config`: a path for data_path().
template <class ConstructedComponent, class Config>
[[nodiscard]] ComponentFactory make_factory(std::string name, std::filesystem::path default_config) {
  return {std::move(name),
          [](Wiring& wiring, const Setup& setup) { return std::make_unique<ConstructedComponent>(wiring, setup); },
          std::move(default_config), describe_parameters<Config>};
}

}  // namespace constrictor
