// The connection to a driver that is no member of the run: the topics hardware/*. This process takes the place of
// plant_relay, to which the driver would talk otherwise.
#pragma once

#include <cstdint>
#include <functional>

#include "conform/plant_port.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/wait_set.hpp"

namespace constrictor::conform {

class HardwarePort final : public PlantPort {
 public:
  /// Joins the domain. `interrupted` is called in each period; true makes advance() throw Interrupted. `restart` does
  /// what PlantPort::restart() promises.
  HardwarePort(std::uint32_t domain, double period_s, std::uint16_t robot_id, std::function<bool()> interrupted,
               std::function<std::string()> restart);
  /// Leaves the joints holding where they were measured last.
  ~HardwarePort() override;

  [[nodiscard]] Abilities abilities() const override { return {true, false, false, true}; }
  void advance(const std::vector<PlantCommand>& commands) override;
  [[nodiscard]] double now_s() const override;
  [[nodiscard]] std::uint64_t session() const override { return session_; }
  [[nodiscard]] std::uint64_t number() const override { return number_; }
  void begin_session() override;
  [[nodiscard]] std::string restart() override { return restart_(); }
  [[nodiscard]] std::uint64_t incarnation() const override { return incarnation_; }
  /// Whether another process commands the joints: nothing must be moved then.
  [[nodiscard]] bool commanded_by_others() const { return others_.writers() > 1; }

 private:
  void send(const PlantCommand& command);
  void take();
  void hold();

  dds::Domain domain_;
  std::uint16_t robot_id_;
  std::int64_t period_ns_;
  std::function<bool()> interrupted_;
  std::function<std::string()> restart_;
  dds::Reader<msg::HardwareJointState> states_;
  dds::Reader<msg::HardwareImuState> inertial_;
  dds::Reader<msg::HardwareContactState> felt_;
  dds::Reader<msg::HardwareJointCommand> others_;
  dds::Writer<msg::HardwareJointCommand> writer_;
  dds::WaitSet wait_set_;
  std::int64_t next_ns_;
  std::uint64_t session_ = 0, number_ = 0;
  std::uint64_t incarnation_ = 0;                ///< session of the newest joint state
  std::vector<double> posture_rad_, limits_nm_;  ///< measured last; torque limits of the last command
};

}  // namespace constrictor::conform
