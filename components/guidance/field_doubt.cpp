// The part of FieldMapper that doubts landmarks which images should show and do not.
#include <algorithm>

#include "guidance/existence.hpp"
#include "guidance/field_mapper.hpp"

namespace constrictor::guidance {
namespace {

constexpr std::size_t kNeck = 2;  // the modules next to the head lie behind the camera
constexpr double kPeg_m = 0.04;   // radius of what stands at a point of an obstacle

}  // namespace

bool FieldMapper::trusted(const Landmark& landmark) const {
  const bool exists = landmark.hits < config_.confirm || probability_of(landmark.log_odds) >= config_.existence.trust;
  return exists && !landmark.may_have_moved;
}

void FieldMapper::replace(Landmark& landmark, const Eigen::Vector2d& z, const Eigen::Matrix2d& noise,
                          std::int64_t tick) {
  release_slot(landmark);
  landmark.slot = static_cast<std::int32_t>(filter_.landmark_count());
  filter_.add(z, noise);
  landmark.strays = 0;
  landmark.may_have_moved = false;
  landmark.last_seen_tick = tick;
}

std::optional<View> FieldMapper::view_with_body(const msg::ObjectPercepts& percepts, const PlanarPose& X_HV,
                                                const BodyChain& chain) const {
  const CameraModel* camera = model_.camera_of(percepts.camera);
  if (camera == nullptr) return std::nullopt;
  const bool further = percepts.camera > 0;  // the origin of V is then below the camera
  View view{*camera,
            further ? Eigen::Vector2d(0.0, 0.0) : Eigen::Vector2d(camera->p_HC.head<2>()),
            further ? model_.module_radius_m + camera->p_HC.z() : 0.0,
            percepts,
            {}};
  const double module_m = 0.5 * model_.module_length_m + model_.module_radius_m;
  for (std::size_t i = further ? 0 : kNeck; i < chain.size(); ++i) {
    if (further && i == camera->module) continue;
    view.screens.push_back({X_HV.to_local(chain[i].p), module_m, 0.0, 2.0 * model_.module_radius_m});
  }
  return view;
}

std::vector<Landmark> FieldMapper::doubt(const msg::ObjectPercepts& percepts, const PlanarPose& exposure,
                                         const BodyChain& chain, bool level, std::int64_t tick, double period_s) {
  const ExistenceConfig& config = config_.existence;
  const PlanarPose X_HV = view_of(percepts, exposure);
  std::optional<View> view = view_with_body(percepts, X_HV, chain);
  if (!view) return {};
  std::int64_t& looked_tick = state_.looked_tick.at(percepts.camera);
  const double since_s = static_cast<double>(tick - looked_tick) * period_s;
  const double looks = std::clamp(since_s / config.look_s, 0.0, 1.0);
  looked_tick = tick;

  const auto disc_of = [&](const Landmark& landmark) {
    return Disc{X_HV.to_local(filter_.pose().to_local(position(landmark))), radius_of(landmark), sd(landmark)};
  };
  for (const Obstacle& obstacle : state_.obstacles) {
    if (believed(obstacle))
      view->screens.push_back(
          {X_HV.to_local(filter_.pose().to_local({obstacle.x_m, obstacle.y_m})), kPeg_m, obstacle.sd_m});
  }
  const std::size_t lasting = view->screens.size();
  std::vector<Landmark> given_up;

  for (std::size_t i = state_.landmarks.size(); i-- > 0;) {
    Landmark& landmark = state_.landmarks[i];
    if (landmark.carried) continue;
    const bool seen = landmark.last_seen_tick == tick;
    if (seen && landmark.proved_tick != tick) {
      landmark.log_odds = updated_log_odds(config, landmark.log_odds, true, looks);
      landmark.proved_tick = tick;
    }
    if (seen || !level || landmark.strays > 0 || landmark.hits < config_.confirm) continue;
    view->screens.resize(lasting);
    for (const Landmark& other : state_.landmarks) {
      if (&other != &landmark && other.kind == msg::kBlobObject) view->screens.push_back(disc_of(other));
    }
    if (!clearly_in_view(config, *view, disc_of(landmark), landmark.colour)) continue;
    landmark.log_odds = updated_log_odds(config, landmark.log_odds, false, looks);
    if (probability_of(landmark.log_odds) >= config.drop) continue;
    release_slot(landmark);
    given_up.push_back(landmark);
    forget(i);
  }
  return given_up;
}

}  // namespace constrictor::guidance
