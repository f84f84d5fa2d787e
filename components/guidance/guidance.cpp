#include "guidance/guidance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "constrictor/constants.hpp"
#include "guidance/plausible.hpp"

namespace constrictor {
namespace {

constexpr std::int64_t kMapPeriodTicks = 5;
constexpr std::int64_t kMapLeastTicks = 3;
constexpr double kSilent_s = 0.2;         // after which guidance does without the IMU
constexpr double kLiftingTime_s = 0.5;    // time constant of the mean rate of the pitch joints
constexpr std::size_t kTrackTicks = 110;  // covers the window of the speed and the delay of any camera

/// [rad] yaw of the x axis in the ground plane, also if the length of the quaternion of an IMU is not exactly 1.
double yaw_of(const msg::Quaternion& q) {
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z);
}

/// Whether the head is tilted by less than about 8 degrees.
bool is_level(const msg::Quaternion& q) { return 1.0 - 2.0 * (q.x * q.x + q.y * q.y) > 0.99; }

}  // namespace

Guidance::Guidance(Wiring& wiring, const Setup& setup)
    : TunableComponent(wiring, setup, topics::kGuidanceParameters),
      log_(setup.log),
      model_(load_robot(setup.robot_file)) {
  if (!model_.further_cameras.empty()) further_.emplace(wiring);
}

void Guidance::dead_reckon(const Tick& tick, const guidance::BodyChain& chain, bool imu) {
  guidance::OdometryInput input;
  input.joint_rad = body_.joints->position_rad;
  input.joint_rad_s = body_.joints->velocity_rad_s;
  const msg::Quaternion q = imu ? imu_->orientation : msg::Quaternion{1.0, 0.0, 0.0, 0.0};
  input.yaw_rad = imu ? yaw_of(q) : std::nan("");
  if (imu && !std::isfinite(input.yaw_rad)) return;
  input.dt_s = static_cast<double>(tick.index - state_.last_tick) * tick.period_s();
  // A robot that has rolled over cannot distinguish ground and wall: only the motion of the body is used.
  const bool upright = 1.0 - 2.0 * (q.x * q.x + q.y * q.y) > 0.8;
  if (upright && body_.contacts && !guidance::implausible(*body_.contacts) &&
      body_.contacts->module_count >= model_.module_count) {
    input.load_n.reserve(model_.module_count);
    input.ground.reserve(model_.module_count);
    for (std::size_t i = 0; i < model_.module_count; ++i) {
      const msg::Vector3& f = body_.contacts->force_n[i];
      input.load_n.push_back(f.z);
      input.ground.push_back({f.x, f.y, f.z});
    }
    // Sum of the sideways pushes. Forces between the robot's own modules cancel in the sum.
    const int count = std::min<int>(body_.contacts->contact_count, msg::kMaxContacts);
    for (int i = 0; i < count; ++i) {
      const msg::Contact& contact = body_.contacts->contacts[i];
      if (contact.module_index >= chain.size() || !(std::abs(contact.normal.z) < config_.touch_max_normal_z)) continue;
      input.ground[contact.module_index].normal_n = std::nan("");  // not only the ground touches this module
      input.push_n += turned({contact.force_n.x, contact.force_n.y}, chain[contact.module_index].yaw_rad);
    }
  }
  if (config_.ground.slope_time_s > 0.0 && imu) {
    state_.slope.learn(q, input.dt_s / config_.ground.slope_time_s);
    input.downhill = turned(state_.slope.downhill(config_.ground.level_rad), -input.yaw_rad);
  } else {
    state_.slope = {};
  }
  const guidance::HeadStep step = guidance::advance_odometry(state_.odometry, model_, config_.odometry, input);
  state_.last_tick = tick.index;

  const double speed_m_s = input.dt_s > 0.0 ? step.step_m.norm() / input.dt_s : 0.0;
  const double share_sd = state_.brushes ? std::max(config_.pushing_speed_sd, config_.speed_sd) : config_.speed_sd;
  const double speed_sd = share_sd * speed_m_s + config_.speed_sd_m_s * (speed_m_s > 0.005 ? 1.0 : 0.1);
  double variance = speed_sd * speed_sd * config_.correlation_s * input.dt_s;
  if (watch_lifting(input.dt_s)) {
    variance +=
        config_.lifting_speed_sd_m_s * config_.lifting_speed_sd_m_s * config_.lifting_correlation_s * input.dt_s;
  }
  const double yaw_sd = imu ? config_.yaw_sd_rad_sqrt_s : config_.unmeasured_yaw_sd_rad_sqrt_s;
  const Eigen::Vector3d noise(variance, variance, yaw_sd * yaw_sd * input.dt_s);
  const double scale_sd = input.ground.empty() ? config_.unmeasured_scale_sd : config_.scale_sd;
  const guidance::ScaledDrift drift{step.drift_m, 1.0 - std::exp(-input.dt_s / config_.scale_s), scale_sd};
  guidance::PoseFilter filter(state_.filter);
  if (const int loaded = state_.field.carrying ? 1 : 0; loaded != state_.scale_loaded) {
    state_.scale_loaded = loaded;
    filter.forget_scale(scale_sd);
  }
  remember(tick.index, filter.predict(step.step_m, step.turn_rad, noise.asDiagonal(), drift), step.turn_rad);
}

bool Guidance::watch_lifting(double dt_s) {
  double sum_rad_s = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    if (model_.joints[i].axis != JointAxis::kPitch) continue;
    sum_rad_s += std::abs(body_.joints->velocity_rad_s[i]);
    ++count;
  }
  if (count == 0) return false;
  const bool lifted = state_.pitch_rate_rad_s > config_.lifting_rad_s;
  state_.pitch_rate_rad_s += (sum_rad_s / count - state_.pitch_rate_rad_s) * std::min(1.0, dt_s / kLiftingTime_s);
  const bool lifts = state_.pitch_rate_rad_s > config_.lifting_rad_s;
  if (lifts && !lifted)
    log_.info(
        "the pitch joints move, so that modules leave the ground: the pose becomes uncertain until images show "
        "what the map contains");
  return lifts;
}

void Guidance::remember(std::int64_t tick, const Eigen::Vector2d& step_m, double turn_rad) {
  PlanarPose last;
  if (!state_.track_tick.empty()) {
    last = {{state_.track_x_m.back(), state_.track_y_m.back()}, state_.track_yaw_rad.back()};
  }
  const Eigen::Vector2d p = last.p + turned(step_m, last.yaw_rad + 0.5 * turn_rad);
  state_.track_tick.push_back(tick);
  state_.track_x_m.push_back(p.x());
  state_.track_y_m.push_back(p.y());
  state_.track_yaw_rad.push_back(wrap_angle_by_shift(last.yaw_rad + turn_rad));
  if (state_.track_tick.size() > kTrackTicks) {
    state_.track_tick.erase(state_.track_tick.begin());
    for (auto* track : {&state_.track_x_m, &state_.track_y_m, &state_.track_yaw_rad}) track->erase(track->begin());
  }
}

PlanarPose Guidance::past(std::int64_t tick) const {
  if (state_.track_tick.empty()) return {};
  const auto found = std::lower_bound(state_.track_tick.begin(), state_.track_tick.end(), tick);
  const std::size_t i = found == state_.track_tick.end() ? state_.track_tick.size() - 1
                                                         : static_cast<std::size_t>(found - state_.track_tick.begin());
  const PlanarPose then{{state_.track_x_m[i], state_.track_y_m[i]}, state_.track_yaw_rad[i]};
  const PlanarPose now{{state_.track_x_m.back(), state_.track_y_m.back()}, state_.track_yaw_rad.back()};
  return {now.to_local(then.p), wrap_angle_by_shift(then.yaw_rad - now.yaw_rad)};
}

double Guidance::speed_m_s(double period_s) const {
  if (state_.track_tick.size() < 2) return 0.0;
  const auto ticks = static_cast<std::int64_t>(std::llround(config_.speed_window_s / period_s));
  const std::int64_t newest = state_.track_tick.back();
  const auto from = std::lower_bound(state_.track_tick.begin(), state_.track_tick.end(), newest - ticks);
  const auto i = static_cast<std::size_t>(from - state_.track_tick.begin());
  if (newest == state_.track_tick[i]) return 0.0;
  // The speed is measured along the mean course, so that the sway of the head does not count.
  Eigen::Vector2d course = Eigen::Vector2d::Zero();
  for (std::size_t k = i; k < state_.track_tick.size(); ++k) course += along(state_.track_yaw_rad[k]);
  if (course.norm() < 1e-6) return 0.0;
  const Eigen::Vector2d moved(state_.track_x_m.back() - state_.track_x_m[i],
                              state_.track_y_m.back() - state_.track_y_m[i]);
  return moved.dot(course.normalized()) / (static_cast<double>(newest - state_.track_tick[i]) * period_s);
}

template <class Message, class... Limits>
bool Guidance::believed(const Latest<Message>& input, const char* topic, Limits... limits) {
  if (!input || !input.fresh()) return false;
  const char* complaint = guidance::implausible(*input, limits...);
  if (complaint) wiring_.count_refusal(std::string(topic) + "." + complaint);
  return !complaint;
}

template <class Message>
std::vector<const Message*> Guidance::believed(const Events<Message>& input, const char* topic) {
  std::vector<const Message*> samples;
  for (const Message& message : input) {
    const char* complaint = guidance::implausible(message);
    if (complaint == nullptr && (message.camera == 0 || model_.camera_of(message.camera) == nullptr))
      complaint = "camera: not one of the robot's further cameras";
    if (complaint) wiring_.count_refusal(std::string(topic) + "." + complaint);
    else samples.push_back(&message);
  }
  return samples;
}

void Guidance::report_full_map(const guidance::FieldMapper& mapper) {
  const std::optional<guidance::Landmark>& left_out = mapper.left_out();
  if (left_out && !state_.left_out) {
    log_.warning(
        "the map is full: it has {} objects and zones, all confirmed. The {} {} at ({:.2f}, {:.2f}) m is left out, and "
        "so is what else is new, until one of these leaves the map: no task finds it, and a touch of it counts as one "
        "of an obstacle",
        msg::kMaxMapObjects, name_of(constants::kColour, left_out->colour), name_of(constants::kBlob, left_out->kind),
        left_out->x_m, left_out->y_m);
    wiring_.count_refusal(fmt::format("perception/objects: found a new object or zone, accepted at most {} in the map",
                                      msg::kMaxMapObjects));
  }
  state_.left_out = left_out || (state_.left_out && mapper.full());
}

void Guidance::map_objects(const Tick& tick, guidance::FieldMapper& mapper, const msg::ObjectPercepts& objects,
                           const guidance::BodyChain& chain, bool level) {
  const PlanarPose exposure = past(objects.exposure_tick);
  mapper.objects(objects, exposure, tick.index);
  mapper.obstacles(objects, exposure, chain, level, tick.index);
  for (const auto& lost : mapper.doubt(objects, exposure, chain, level, tick.index, tick.period_s())) {
    log_.warning("the {} {} {} is not at ({:.2f}, {:.2f}) m any more, where images should show it: left the map",
                 name_of(constants::kColour, lost.colour), name_of(constants::kBlob, lost.kind), lost.handle, lost.x_m,
                 lost.y_m);
  }
}

void Guidance::map_further(const Tick& tick, guidance::FieldMapper& mapper, const guidance::BodyChain& chain,
                           bool level) {
  for (const auto* line : believed(further_->lines, "perception/further/line"))
    mapper.line(*line, past(line->exposure_tick), tick.index, tick.period_s());
  for (const auto* objects : believed(further_->objects, "perception/further/objects"))
    map_objects(tick, mapper, *objects, chain, level);
}

void Guidance::step(const Tick& tick) {
  parameters_.step(tick, state_.parameters);
  guidance::PoseFilter filter(state_.filter);
  const std::size_t joint_count = model_.joints.size();
  const bool joints = believed(body_.joints, "joint_state", joint_count);
  const bool imu = believed(imu_, "imu_state");
  const bool line = believed(percepts_.line, "perception/line");
  const bool objects = believed(percepts_.objects, "perception/objects");
  const bool contacts = believed(body_.contacts, "contact_state");
  if (imu) state_.imu_tick = tick.index;
  const bool silent = !model_.imu || static_cast<double>(tick.index - state_.imu_tick) * tick.period_s() > kSilent_s;
  if (silent && !state_.imu_silent && model_.imu)
    log_.warning("no plausible imu_state for {} s: the turns of the body follow from its joints alone", kSilent_s);
  state_.imu_silent = silent;
  if (joints && (imu || silent)) {
    const guidance::BodyChain chain = planar_module_poses(model_, {body_.joints->position_rad, joint_count});
    dead_reckon(tick, chain, imu);
    double sum_rad = 0.0;
    for (const auto& module : chain) sum_rad += module.yaw_rad;
    state_.body_turn_rad = sum_rad / static_cast<double>(chain.size());
    guidance::FieldMapper mapper(state_.field, filter, model_, config_);
    if (task_) mapper.carry(*task_, chain, tick.index);
    if (line) mapper.line(*percepts_.line, past(percepts_.line->exposure_tick), tick.index, tick.period_s());
    const bool level = !imu || is_level(imu_->orientation);
    if (objects) map_objects(tick, mapper, *percepts_.objects, chain, level);
    if (further_) map_further(tick, mapper, chain, level);
    report_full_map(mapper);
    if (contacts) mapper.touch(*body_.contacts, chain, tick.index, tick.period_s());
    state_.brushes = (!body_.contacts || body_.contacts->module_count == 0) && mapper.brush(chain);
  }

  const PlanarPose estimate = filter.pose();
  msg::RobotPose pose{};
  pose.x_m = estimate.p.x();
  pose.y_m = estimate.p.y();
  pose.yaw_rad = estimate.yaw_rad;
  pose.body_yaw_rad = wrap_angle_by_shift(estimate.yaw_rad + state_.body_turn_rad);
  pose.speed_m_s = speed_m_s(tick.period_s());
  const Eigen::Matrix3d covariance = filter.pose_covariance();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) pose.covariance[3 * i + j] = covariance(i, j);
  }
  pose_.write(pose);

  // As often as the images come, and in the tick in which they come.
  const std::int64_t since_ticks = tick.index - state_.map_tick;
  if (since_ticks >= kMapPeriodTicks || (objects && since_ticks >= kMapLeastTicks)) {
    state_.map_tick = tick.index;
    msg::FieldMap map{};
    guidance::FieldMapper(state_.field, filter, model_, config_).fill(map);
    map_.write(map);
  }
}

ComponentFactory make_guidance_factory() {
  return make_factory<Guidance, guidance::GuidanceConfig>("guidance", "components/guidance/guidance.yaml");
}

}  // namespace constrictor
