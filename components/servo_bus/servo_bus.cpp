#include "servo_bus/servo_bus.hpp"

#include <fmt/format.h>

#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <utility>

#include "component/data_path.hpp"
#include "component/default_robot.hpp"
#include "configuration/configuration.hpp"
#include "constrictor/archive.hpp"
#include "serial/serial_port.hpp"

namespace constrictor {
namespace {

constexpr std::int64_t kRecordEvery_ticks = 50;
constexpr int kMostLogLines = 30;  // in a window of NewsLog

dynamixel::BusPlan plan_of(const ServoBusConfig& config, const RobotModel& robot) {
  const std::filesystem::path file = data_path(config.bus_file);
  dynamixel::BusPlan plan = dynamixel::load_bus_plan(file, data_path("components/lib/dynamixel/models"));
  if (plan.joints.size() != robot.joints.size())
    throw ConfigurationError(fmt::format("{}: joints: found {}, accepted {}, as robot {} has", file.string(),
                                         plan.joints.size(), robot.joints.size(), robot.name));
  return plan;
}

/// Opens serial ports; relative names belong to the output folder of the run.
OpenPort serial_ports(const std::filesystem::path& folder) {
  return [folder](const dynamixel::BusPort& port, double patience_s) -> std::unique_ptr<serial::Port> {
    return serial::wait_for_port(folder / port.device, port.baud, patience_s);
  };
}

}  // namespace

ServoBus::ServoBus(Wiring& wiring, const Setup& setup, const OpenPort& open)
    : wiring_(wiring),
      log_(setup.log),
      config_(load_parameters<ServoBusConfig>(setup.config_file)),
      robot_(load_robot(robot_file_of(setup))),
      plan_(plan_of(config_, robot_)),
      ports_(plan_.ports, config_.answer_slack_s, open ? open : serial_ports(setup.output_dir)),
      servos_(plan_, robot_, config_, ports_),
      boards_(plan_, ports_),
      record_(setup.output_dir),
      news_log_(setup.log, kMostLogLines, "more events were left out; servo_bus.json shows the newest ones"),
      gate_(wiring, robot_, config_.command),
      stuck_(robot_.joints.size(), config_.stuck_ticks()),
      angles_rad_(robot_.joints.size()),
      rates_rad_s_(robot_.joints.size()),
      torques_nm_(robot_.joints.size()) {}

ServoBus::~ServoBus() { release(); }

void ServoBus::release() {
  if (!started_ || std::exchange(released_, true)) return;
  for (const auto& line : servos_.release(config_.torque_off_at_exit)) log_.warning("{}", line);
  for (const auto& news : servos_.take_news()) log_.warning("{}", news.text);  // a port is gone
}

void ServoBus::start() {
  // A successor must not give up the run, and must be quicker than the watchdogs of the servos that do answer: what is
  // missing now is lost, and may come back.
  std::vector<BusNews> missing;
  try {
    if (continued_) ports_.open_present(missing);
    else ports_.open_all(config_.port_patience_s);
  } catch (const serial::PortError& error) {
    throw ConfigurationError(error.what());
  }
  for (const auto& news : missing) report(news);
  const std::vector<std::string> failed = servos_.start(continued_ ? 0.0 : config_.servo_patience_s);
  if (!failed.empty() && !continued_)
    throw ConfigurationError(
        fmt::format("{} of {} servos cannot be started (`constrictor servo scan` shows which servos "
                    "answer):\n  {}",
                    failed.size(), servos_.count(), fmt::join(failed, "\n  ")));
  for (const auto& line : failed) report({line});
  for (std::size_t port = 0; port < ports_.size(); ++port) {
    if (const std::string why = servos_.slow_because(port); !why.empty())
      log_.info("port {}: the servos are asked with Sync Read, which takes longer: {}", ports_.port(port).device, why);
  }
  started_ = true;
}

void ServoBus::measure() {
  if (started_) servos_.measure();
  else start();
}

void ServoBus::report_news() {
  for (const auto& list : {servos_.take_news(), boards_.take_news()}) {
    for (const auto& news : list) report(news);
  }
}

void ServoBus::report(const BusNews& news) {
  if (!news.is_good) wiring_.count_refusal(news.text);
  news_log_.write(news.text, news.is_good);
  record_.add_news(news.text);
}

void ServoBus::look_for_stuck_joints(std::span<const JointSetpoint> goals) {
  for (const auto& [joint, stuck, goal_rad] : stuck_.look(goals, angles_rad_)) {
    const std::string name = servos_.name_of(joint);
    if (!stuck) report({name + " moves again", true});
    else
      report({fmt::format("{} does not move, although its goal moved by {:.2f} rad in {:g} s: is the joint blocked?",
                          name, goal_rad, config_.stuck_after_s)});
  }
}

void ServoBus::write_joints(double elapsed_s) {
  msg::JointState state{};
  state.joint_count = static_cast<std::uint16_t>(servos_.count());
  for (std::size_t i = 0; i < servos_.count(); ++i) {
    const JointReading& reading = servos_.reading(i);
    angles_rad_[i] = reading.angle_rad;
    rates_rad_s_[i] = reading.rate_rad_s;
    torques_nm_[i] += (reading.torque_nm - torques_nm_[i]) * elapsed_s / (robot_.torque_filter_s + elapsed_s);
    state.position_rad[i] = reading.angle_rad;
    state.velocity_rad_s[i] = reading.rate_rad_s;
    state.torque_nm[i] = torques_nm_[i];
  }
  joint_state_.write(state);
}

void ServoBus::sample(const Tick& tick) {
  const std::int64_t before_ns = ports_.now_ns();
  measure();
  const auto imu = boards_.imu();
  const msg::ContactState contacts = boards_.contacts();
  news_log_.at(tick.index);
  bus_time_ns_ = before_ns == 0 ? 0 : ports_.now_ns() - before_ns;
  report_news();
  if (servos_.locked() && !locked_) {
    locked_ = true;
    gate_.stop("bus_watchdog");
  }
  gate_.sample(tick);
  write_joints(tick.period_s());
  contact_state_.write(contacts);
  if (imu) imu_state_.write(*imu);
  pace_.look(tick, ports_.now_ns(), "real servos");
}

void ServoBus::step(const Tick& tick) {
  const std::int64_t before_ns = ports_.now_ns();
  const bool stopped = gate_.stopped();
  if (locked_ && !stopped) {
    servos_.unlock();
    locked_ = servos_.locked();
    gate_.begin_at_posture();
  }
  const bool hold = locked_ || !servos_.complete();
  if (held_ && !hold) gate_.begin_at_posture();
  held_ = hold;
  const auto& goals = gate_.setpoints(tick, {angles_rad_, rates_rad_s_}, hold);
  servos_.command(goals);
  look_for_stuck_joints(goals);
  const std::int64_t now_ns = ports_.now_ns();
  if (bus_time_ns_ > 0 && now_ns > 0) record_.add_duration(bus_time_ns_ + now_ns - before_ns);
  if (tick.index % kRecordEvery_ticks == 0) record_.write(tick.index, servos_, ports_);
}

std::string ServoBus::save() const { return save_bytes(gate_, angles_rad_, torques_nm_, boards_.start_yaw_rad()); }

void ServoBus::load(const std::string& bytes) {
  double start_yaw_rad = 0.0;
  load_bytes(bytes, gate_, angles_rad_, torques_nm_, start_yaw_rad);
  boards_.set_start_yaw(start_yaw_rad);
  continued_ = true;
}

ComponentFactory make_servo_bus_factory(const OpenPort& open) {
  return {"servo_bus",
          [open](Wiring& wiring, const Setup& setup) { return std::make_unique<ServoBus>(wiring, setup, open); },
          "components/servo_bus/servo_bus.yaml", describe_parameters<ServoBusConfig>};
}

}  // namespace constrictor
