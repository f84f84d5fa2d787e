// Which parameters one viewer has subscribed to, and which values it knows. Pure: no sockets, no DDS.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "dashboard/protocol.hpp"

namespace constrictor::dashboard {

using ParameterMap = std::map<std::string, ParameterValue>;  ///< by name

class ViewerParameters {
 public:
  /// Subscribes to these parameters; without names, to all of them, also to those that are not known yet. The viewer
  /// knows the present values.
  void subscribe(const std::vector<std::string>& names, const ParameterMap& present);
  /// Unsubscribes from these parameters; without names, from all.
  void unsubscribe(const std::vector<std::string>& names);
  /// These values were sent to the viewer.
  void sent(const std::vector<ParameterValue>& values);
  /// The subscribed parameters whose values are not those that the viewer knows. They count as sent.
  [[nodiscard]] std::vector<ParameterValue> news(const ParameterMap& present);

 private:
  [[nodiscard]] bool wants(const std::string& name) const { return all_ != names_.contains(name); }
  bool all_ = false;
  std::set<std::string> names_;  ///< subscribed ones; if all are, the exceptions
  std::map<std::string, nlohmann::json> known_;
};

/// The present values of these parameters, or without names of all. `missing` receives the names of those that are not
/// there.
[[nodiscard]] std::vector<ParameterValue> values_of(const std::vector<std::string>& names, const ParameterMap& present,
                                                    std::vector<std::string>& missing);

}  // namespace constrictor::dashboard
