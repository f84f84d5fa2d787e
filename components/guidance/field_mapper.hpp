// Builds the map from percepts and touch, and corrects the pose by what is recognised.
#pragma once

#include "constrictor/messages.hpp"
#include "guidance/field_state.hpp"
#include "guidance/guidance_config.hpp"
#include "guidance/pose_filter.hpp"
#include "robot/kinematics.hpp"

namespace constrictor::guidance {

/// Modules in the head's frame, head to tail.
using BodyChain = std::vector<PlanarPose>;

/// Works on a FieldState and a PoseFilter owned by the caller. `exposure` is where the head was when the image was taken,
/// relative to where it is now (its pose now is zero), so that percepts are not smeared by motion and delay.
class FieldMapper {
 public:
  FieldMapper(FieldState& state, PoseFilter& filter, const RobotModel& model, const GuidanceConfig& config);

  /// Percepts with NaN range refresh a known landmark but place nothing.
  void objects(const msg::ObjectPercepts& percepts, const Pose2& exposure, std::int64_t tick);
  void line(const msg::LinePercept& percept, const Pose2& exposure, std::int64_t tick, double period_s);
  void touch(const msg::ContactState& contacts, const BodyChain& chain, std::int64_t tick, double period_s);
  /// The object in the U moves with the body.
  void carry(const msg::TaskStatus& task, const BodyChain& chain, std::int64_t tick);

  void fill(msg::FieldMap& map) const;

 private:
  [[nodiscard]] Eigen::Vector2d position(const Landmark& landmark) const;
  [[nodiscard]] double sd(const Landmark& landmark) const;
  void place(const msg::Blob& blob, const Pose2& exposure, std::int64_t tick, std::vector<bool>& used);
  void glimpse(const msg::Blob& blob, const Pose2& exposure, std::int64_t tick);
  void create(const msg::Blob& blob, const Eigen::Vector2d& z, const Eigen::Matrix2d& noise, std::int64_t tick);
  void forget(std::size_t index);
  void release_slot(Landmark& landmark);
  [[nodiscard]] bool is_self(const BodyChain& chain, std::size_t module, const Eigen::Vector2d& p) const;
  [[nodiscard]] Eigen::Vector2d base_of_u(const BodyChain& chain, double radius_m) const;

  FieldState& state_;
  PoseFilter& filter_;
  const RobotModel& model_;
  const GuidanceConfig& config_;
};

}  // namespace constrictor::guidance
