#include "conform/member_port.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "constrictor/reflect.hpp"

namespace constrictor::conform {
namespace {

constexpr std::chrono::seconds kMostSilence{15};  // a restarted plant needs some seconds

double clock_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Takes the place of `control`: passes its inputs to the checks, and writes the command that they give.
class ConformControl final : public Component {
 public:
  ConformControl(Wiring& wiring, TickExchange& exchange)
      : wiring_(wiring),
        exchange_(exchange),
        joints_(wiring.events(topics::kJointState)),
        contacts_(wiring.events(topics::kContactState)),
        imus_(wiring.events(topics::kImuState)),
        stop_(wiring.latest(topics::kStopState)),
        out_(wiring.output(topics::kJointCommand)) {}

  void step(const Tick& tick) override {
    const auto command = exchange_.step(observe(tick));
    if (exchange_.finished()) wiring_.request_end_of_run();
    if (!command) return;
    msg::JointCommand message{};
    message.mode = command->relaxed ? msg::kServoRelaxed : command->torque ? msg::kServoTorque : msg::kServoFollow;
    const std::size_t count = std::min<std::size_t>(command->position_rad.size(), msg::kMaxJoints);
    message.joint_count = static_cast<std::uint16_t>(count);
    std::copy_n(command->position_rad.begin(), count, message.position_rad);
    std::copy_n(command->velocity_rad_s.begin(), count, message.velocity_rad_s);
    std::copy_n(command->torque_limit_nm.begin(), count, message.torque_limit_nm);
    std::copy_n(command->torque_nm.begin(), count, message.torque_nm);
    out_.write(message);
  }
  [[nodiscard]] std::string save() const override { return {}; }
  void load(const std::string&) override {}

 private:
  TickExchange::Observed observe(const Tick& tick) const {
    TickExchange::Observed seen;
    seen.epoch = tick.epoch;
    seen.tick = tick.index;
    seen.stopped = stop_ && stop_->stopped;
    const double arrival_s = clock_s();
    for (const auto& state : joints_) {
      JointSample sample;
      sample.session = state.header.run_id;
      sample.number = state.header.sequence_number;
      sample.time_ns = state.header.time_ns;
      sample.arrival_s = arrival_s;
      sample.position_rad.assign(state.position_rad, state.position_rad + state.joint_count);
      sample.velocity_rad_s.assign(state.velocity_rad_s, state.velocity_rad_s + state.joint_count);
      sample.torque_nm.assign(state.torque_nm, state.torque_nm + state.joint_count);
      seen.joints.push_back(std::move(sample));
    }
    for (const auto& imu : imus_) {
      const auto& q = imu.orientation;
      const auto &w = imu.angular_velocity_rad_s, &a = imu.linear_acceleration_m_s2;
      seen.imus.push_back({{q.w, q.x, q.y, q.z}, {w.x, w.y, w.z}, {a.x, a.y, a.z}});
    }
    for (const auto& contact : contacts_)
      seen.contacts.push_back({contact.module_count, contact.contact_count, !validate(contact)});
    return seen;
  }

  Wiring& wiring_;
  TickExchange& exchange_;
  Events<msg::JointState> joints_;
  Events<msg::ContactState> contacts_;
  Events<msg::ImuState> imus_;
  Latest<msg::StopState> stop_;
  Output<msg::JointCommand> out_;
};

}  // namespace

std::optional<PlantCommand> TickExchange::step(const Observed& observed) {
  const std::lock_guard lock(mutex_);
  if (observed.epoch != observed_.epoch) observed_ = {};
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(observed_.joints, observed.joints);
  append(observed_.imus, observed.imus);
  append(observed_.contacts, observed.contacts);
  observed_.stopped = observed.stopped;
  observed_.epoch = observed.epoch;
  observed_.tick = observed.tick;
  ++steps_;
  stepped_.notify_all();
  return std::exchange(command_, std::nullopt);
}

TickExchange::Observed TickExchange::advance(std::optional<PlantCommand> command) {
  std::unique_lock lock(mutex_);
  command_ = std::move(command);
  const std::uint64_t before = steps_;
  const bool stepped = stepped_.wait_for(lock, kMostSilence, [&] { return ended_ || steps_ != before; });
  if (ended_) throw PlantGone("the run has ended; its log says why");
  if (!stepped) throw PlantGone("the run makes no ticks");
  Observed observed = std::move(observed_);
  observed_ = {};
  observed_.epoch = observed.epoch;
  return observed;
}

void TickExchange::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  stepped_.notify_all();
}

void MemberPort::advance(const std::vector<PlantCommand>& commands) {
  TickExchange::Observed seen = exchange_.advance(commands.empty() ? std::nullopt : std::optional(commands.back()));
  joints_ = std::move(seen.joints);
  imus_ = std::move(seen.imus);
  contacts_ = std::move(seen.contacts);
  stopped_ = seen.stopped;
  epoch_ = seen.epoch;
}

double MemberPort::now_s() const { return clock_s(); }

ComponentFactory make_conform_factory(TickExchange& exchange) {
  return {"control",
          [&exchange](Wiring& wiring, const Setup&) { return std::make_unique<ConformControl>(wiring, exchange); }};
}

}  // namespace constrictor::conform
