// The series-elastic robot follows a line nearly as fast as the stiff robot, its odometry agrees with ground truth, and
// the deflection of each joint's spring is its torque divided by its stiffness.
#include "behaviour_run.hpp"

namespace constrictor::testing {
namespace {

constexpr const char* kBend =
    "name: bend\nline: {colour: blue, width_m: 0.05, begin_m: [0.2, 0], segments: [{length_m: 0.8}, {length_m: 2.5, "
    "curvature_1_m: 0.5}]}\n"
    "start: {frame: world, position_m: [0, 0]}\nnoise: {sensors: true, camera_sd: 0.01}\n";

/// Sums over time and joints of a spring's deflection and torque.
struct Spring {
  double deflection2 = 0.0, torque2 = 0.0, product = 0.0;
  [[nodiscard]] double stiffness_nm_rad() const { return product / std::max(1e-12, deflection2); }  // 0: no deflection
  [[nodiscard]] double correlation() const { return product / std::sqrt(std::max(1e-12, deflection2 * torque2)); }
};

class SerpensBehaviour : public Behaviour {
 protected:
  struct Run {
    double distance_m = 0.0;    ///< distance that the head has moved along the line
    double from_line_m = 0.0;   ///< rms distance of the head from the line, including the sway of the gait
    double pose_error_m = 0.0;  ///< distance of guidance's estimate from the true position at the end
    double most_deflection_rad = 0.0;
    Spring spring;
  };
  Run follow(const std::string& robot, double duration_s) {
    robot_ = robot;
    happened.clear();
    begin(kBend);
    const World& simulated = static_cast<Physics&>(run_->component("physics")).world();
    start(msg::kTaskFollowLine, &msg::TaskParameters::line_colour, msg::kColourBlue);
    Run way;
    int count = 0;
    until(
        [&] {
          for (std::size_t j = 0; j < simulated.joint_count(); ++j) {
            const JointDrive& joint = simulated.joint(j);
            const double deflection_rad = joint.motor_angle_rad() - joint.angle_rad();
            way.most_deflection_rad = std::max(way.most_deflection_rad, std::abs(deflection_rad));
            way.spring.deflection2 += deflection_rad * deflection_rad;
            way.spring.torque2 += joint.step_torque_nm() * joint.step_torque_nm();
            way.spring.product += joint.step_torque_nm() * deflection_rad;
          }
          const auto points = line();
          std::size_t nearest = 0;
          for (std::size_t i = 0; i < points.size(); ++i) {
            if (points[i].distance_m(head()) < points[nearest].distance_m(head())) nearest = i;
          }
          way.distance_m = 0.0;
          for (std::size_t i = 1; i <= nearest; ++i) way.distance_m += points[i].distance_m(points[i - 1]);
          way.from_line_m += points[nearest].distance_m(head()) * points[nearest].distance_m(head());
          ++count;
          return false;
        },
        duration_s);
    way.from_line_m = std::sqrt(way.from_line_m / count);
    const auto& pose = *run_->latest(topics::kRobotPose);
    way.pose_error_m = head().distance_m({pose.x_m, pose.y_m, pose.yaw_rad});  // the robot starts at W's origin: M = W
    std::printf(
        "%s: %.2f m along the line, %.3f m from it rms, pose error %.3f m, deflection to %.3f rad, %.1f Nm/rad, "
        "correlation %.3f\n",
        robot.c_str(), way.distance_m, way.from_line_m, way.pose_error_m, way.most_deflection_rad,
        way.spring.stiffness_nm_rad(), way.spring.correlation());
    return way;
  }
};

TEST_F(SerpensBehaviour, FollowsALineNearlyAsFastAsTheStiffRobot) {
  constexpr double kDuration_s = 5.0;
  const Run stiff = follow("mamba", kDuration_s);
  const Run elastic = follow("serpens", kDuration_s);
  EXPECT_EQ(stiff.most_deflection_rad, 0.0);
  EXPECT_GT(stiff.distance_m, 1.5);
  EXPECT_GT(elastic.distance_m, 0.7 * stiff.distance_m);
  EXPECT_LT(elastic.distance_m, 1.1 * stiff.distance_m);
  EXPECT_LT(elastic.from_line_m, 0.12);
  EXPECT_LT(elastic.pose_error_m, 0.1);
  EXPECT_FALSE(first(msg::kEventLineLost));
  // Hooke's law must hold over all joints and ticks. The damping torque is not in phase with the deflection, therefore
  // the correlation is less than 1.
  const RobotModel robot = load_robot(data_path("components/lib/robot/serpens.yaml"));
  EXPECT_GT(elastic.most_deflection_rad, 0.01);
  EXPECT_NEAR(elastic.spring.stiffness_nm_rad(), robot.joints[0].stiffness_nm_rad,
              0.1 * robot.joints[0].stiffness_nm_rad);
  EXPECT_GT(elastic.spring.correlation(), 0.9);
}

}  // namespace
}  // namespace constrictor::testing
