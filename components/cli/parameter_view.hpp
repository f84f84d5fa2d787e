// The run-time parameters of a run, as their owners announce them.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor::cli {

/// A parameter and whose it is.
struct OwnedParameter {
  std::string owner;
  msg::Parameter parameter{};
};

struct ParameterView {
  std::map<std::string, OwnedParameter> parameters;  ///< by name
  std::vector<std::string> silent;                   ///< components that have such a list but have not written it yet
};

/// Reads what the owners keep for late readers, over a DDS participant; waits until nothing
/// new comes, at most `bound`.
ParameterView read_parameters(std::int32_t participant, std::chrono::milliseconds bound = std::chrono::milliseconds(2000));

/// For people: "0.05 to 2 Hz".
std::string accepted_text(const msg::Parameter& parameter);
/// For people: a value with its unit, "0.7 Hz".
std::string value_text(const msg::Parameter& parameter, double value);
/// For scripts: everything; `pending` and `changed_tick` are null if there are none.
nlohmann::ordered_json to_json(const OwnedParameter& owned);

}  // namespace constrictor::cli
