// The run-time parameters of a run, as their owners announce them.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/request_client.hpp"
#include "constrictor/messages.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {

/// A parameter and the component that owns it.
struct OwnedParameter {
  std::string owner;
  msg::Parameter parameter{};
};

struct ParameterView {
  std::map<std::string, OwnedParameter> parameters;  ///< by name: "navigation.travel.speed_m_s"
  std::vector<std::string> silent;  ///< components of the run that have a parameter list but have not published it yet
};

/// Follows the parameter lists of all components of a run, or of a replay, in a DDS domain.
class ParameterReader {
 public:
  explicit ParameterReader(std::int32_t participant);
  /// Takes the lists that have arrived. Returns whether one has. Never waits.
  bool poll();
  /// The parameters by name. Writers keep several lists for late readers; the newest one that has arrived counts.
  [[nodiscard]] std::map<std::string, OwnedParameter> parameters() const;
  /// Components that write a list by what `has_writer(topic)` says, but none of which a list has arrived.
  [[nodiscard]] std::vector<std::string> silent(const std::function<bool(std::string_view topic)>& has_writer) const;
  /// Whether a list of every component that the table of topics names has arrived.
  [[nodiscard]] bool complete() const;
  /// Whether the lists of all components of the run have arrived and show every change of a parameter that has. An
  /// owner publishes its list a tick after the change. False at first, until discovery has met all writers.
  [[nodiscard]] bool up_to_date() const;

 private:
  struct Source {
    const TopicInfo* topic;
    dds::Reader<msg::ParameterList> reader;
    std::optional<msg::ParameterList> newest;
  };
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::vector<Source> sources_;
  dds::Reader<msg::ParameterChange> changes_;
  std::map<std::string, msg::ParameterChange> newest_changes_;  ///< by parameter
};

/// Whether the owner of a parameter had received this change of it when it made the list: the value is in force, or it
/// waits for its tick, or the list shows an earlier change that also waits. A list of a later epoch is newer than the
/// change, because a reset brings the defaults back. True for a list of another component.
[[nodiscard]] bool has_taken(const msg::ParameterList& list, const msg::ParameterChange& change);

/// Reads the parameter lists of all components over a DDS participant. Returns when no new list has arrived for a short
/// time, or after `bound`.
ParameterView read_parameters(std::int32_t participant,
                              std::chrono::milliseconds bound = std::chrono::milliseconds(2000));

/// ", did you mean 'PARAMETER'?" for an error message about a name that is not known, or nothing. Unless the name is a
/// slip of the pen, the parameters of the component that end with the same part are named, for `control.method` those
/// of all motions.
[[nodiscard]] std::string did_you_mean(const std::string& name, const std::map<std::string, OwnedParameter>& known);

/// Changes parameters through a client, which needs no authority for that.
class ParameterSetter {
 public:
  /// `client` must outlive this object.
  explicit ParameterSetter(RequestClient& client);
  /// Sets a parameter at `tick` (0: the next tick) and waits until `input` forwards the change. Returns the change,
  /// with the value and the tick from which it is in force. Throws CommandError: kRefused with the reason, kNoAnswer,
  /// kInterrupted.
  msg::ParameterChange set(const std::string& name, double value, std::int64_t tick = 0,
                           std::chrono::milliseconds bound = std::chrono::seconds(5));

 private:
  RequestClient& client_;
  dds::Reader<msg::ParameterChange> changes_;
};

/// The value that is in force or, if an accepted change waits for its tick, the value that will be.
[[nodiscard]] double coming_value(const msg::Parameter& parameter);
/// The value that a text stands for: a finite number, or one of the parameter's names. Empty: neither.
std::optional<double> value_from(const msg::Parameter& parameter, const std::string& text);
/// The same for a JSON number or text. Empty for everything else.
std::optional<double> value_from_json(const msg::Parameter& parameter, const nlohmann::json& value);
/// A value as its name, if it has one, else as a number that is whole if the parameter is.
nlohmann::json value_json(const msg::Parameter& parameter, double value);
/// The accepted values with their unit, for people: "0.05 to 2 Hz", "one of undulation, rolling".
std::string accepted_text(const msg::Parameter& parameter);
/// A value with its unit, for people: "0.7 Hz", "undulation".
std::string value_text(const msg::Parameter& parameter, double value);
/// All fields of a parameter, for scripts. A value that has a name is given by its name. `pending` is null if no change
/// is waiting; `changed_tick` is null if the parameter has not been changed.
nlohmann::ordered_json to_json(const OwnedParameter& owned);

}  // namespace constrictor
