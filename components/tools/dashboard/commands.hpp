// Carries out what viewers command, in threads of its own, because commands wait for their answers.
#pragma once

#include <atomic>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/parameters.hpp"
#include "client/request_client.hpp"
#include "client/run_control_client.hpp"
#include "client/run_monitor.hpp"
#include "client/run_registry.hpp"
#include "dashboard/controls.hpp"
#include "dashboard/driver.hpp"
#include "dashboard/lane.hpp"
#include "dashboard/web_server.hpp"

namespace constrictor::dashboard {

/// The service that lists all parameters. Its answer is parameters_text().
inline constexpr const char* kParameterList = "param_list";
[[nodiscard]] std::string parameters_text(const std::map<std::string, OwnedParameter>& parameters);

/// The services that the page and other viewers can call: `pause`, `resume`, `step` {"ticks": N}, `pace` {"pace": X}
/// (0: as fast as possible), `stop` (emergency stop), `clear_stop`, `param_list`, `param_set` {"name", "value"}, and
/// those of Driver. The run accepts or refuses them like the commands of `constrictor`.
class Commands : public Controls {
 public:
  /// `log`: of the program, for errors that answer no call.
  Commands(const RunNote& run, const Log& log);
  ~Commands() override;

  [[nodiscard]] std::vector<std::string> services() const override;
  [[nodiscard]] std::int32_t participant() const override { return driver_.participant(); }
  void add(WebServer::Call call) override;
  [[nodiscard]] std::string frozen() const override { return {}; }
  void change(WebServer::Change change) override;
  void poll() override;
  [[nodiscard]] std::string over() const override { return monitor_.attachment().over(); }
  [[nodiscard]] std::optional<msg::RunState> run() const override { return monitor_.state(); }

 private:
  std::string control(const WebServer::Call& call);
  std::string stop(const WebServer::Call& call);
  std::string parameter(const WebServer::Call& call);
  std::string change_all(const nlohmann::json& wishes);

  std::atomic<bool> ending_ = false;
  Driver driver_;
  RunControlClient run_;
  RequestClient stops_, parameters_;  // each is used in one thread only
  ParameterSetter setter_;
  RunMonitor monitor_;
  Answers answers_;
  Lane control_lane_, stop_lane_, driver_lane_, parameter_lane_;
};

}  // namespace constrictor::dashboard
