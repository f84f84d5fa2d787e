// The gait's joint angles against the closed formula, and geometric properties of postures.
#include "control/yaw_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "component/data_path.hpp"
#include "control/control_config.hpp"

namespace constrictor {
namespace {

constexpr double kBase_rad = std::numbers::pi / 3.0;

class YawChainTest : public ::testing::Test {
 protected:
  RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  YawChain chain{robot};
  WaveWeights weights = ControlConfig{}.weights;
  static LinkArray u_shape(double side) {
    LinkArray shape{};
    shape[5] = shape[6] = shape[7] = side * kBase_rad;
    return shape;
  }
};

TEST_F(YawChainTest, HasThirteenLinksOfMamba) {
  EXPECT_EQ(chain.joint_count(), 12U);
  EXPECT_EQ(chain.link_count(), 13U);
  EXPECT_NEAR(chain.link_length_m(), 0.178, 1e-12);
  // Link 3 is modules 5 and 6: its middle lies 5.5 modules behind the head.
  EXPECT_NEAR(chain.arc_coordinates()[3], -5.5 * 0.089, 1e-12);
}

TEST_F(YawChainTest, StraightWaveFollowsTheClosedFormula) {
  Wave wave;
  wave.amplitude_rad = 0.5;
  wave.wavelength_m = 1.07;
  wave.curvature_1_m = 0.7;
  wave.phase_rad = 1.3;
  const LinkArray angle = chain.joint_angles({}, wave, weights);
  // Away from the head the weights are 1: q = kappa l + A (cos a - cos b) = kappa l - 2 A sin((a+b)/2) sin((a-b)/2).
  for (std::size_t k = 4; k < 10; ++k) {
    const double middle_m = -(2.0 * static_cast<double>(k) + 0.5) * 0.089;  // joint 2k
    const double number = 2.0 * std::numbers::pi / 1.07;
    const double expected = 0.7 * 0.178 - 2.0 * 0.5 * std::sin(number * middle_m + 1.3) * std::sin(number * 0.089);
    EXPECT_NEAR(angle[k], expected, 1e-12) << "joint " << k;
  }
}

TEST_F(YawChainTest, CurvatureAloneBendsTheBodyIntoACircle) {
  Wave wave;
  wave.curvature_1_m = 0.8;
  const LinkArray angle = chain.joint_angles({}, wave, weights);
  for (std::size_t k = 1; k + 1 < chain.joint_count(); ++k) EXPECT_NEAR(angle[k], 0.8 * 0.178, 1e-12);
}

TEST_F(YawChainTest, UTurnsBackByHalfATurnToTheSideOfTheObject) {
  for (const double side : {1.0, -1.0}) {
    const LinkArray heading = chain.headings(u_shape(side));
    EXPECT_NEAR(heading[12], -side * std::numbers::pi, 1e-12);
    const LinkArray x = chain.coordinates(heading);
    EXPECT_LT(x[6], x[2]);
    EXPECT_GT(x[12], x[8]);  // the tail's arm comes forward again
  }
}

TEST_F(YawChainTest, ArmsOfAUUndulateInParallel) {
  Wave wave;
  wave.amplitude_rad = 0.4;
  wave.wavelength_m = 1.07;
  wave.phase_rad = 0.4;
  const LinkArray shape = u_shape(1.0);
  const LinkArray theta = chain.headings(shape);
  const LinkArray x = chain.coordinates(theta);
  const LinkArray angle = chain.joint_angles(shape, wave, weights);
  LinkArray heading{};
  for (std::size_t k = 0; k < chain.joint_count(); ++k) heading[k + 1] = heading[k] - angle[k];
  // The wave's part of a link's heading depends on its X alone, whichever arm it belongs to.
  for (std::size_t k : {3U, 4U, 9U, 10U, 11U, 12U}) {
    const double part = heading[k] - theta[k];
    EXPECT_NEAR(part, wave.amplitude_rad * std::cos(2.0 * std::numbers::pi * x[k] / 1.07 + 0.4), 1e-12);
  }
}

TEST_F(YawChainTest, BaseLinksAreStillAndTheirNeighboursAreNot) {
  const LinkArray w = chain.weights(u_shape(-1.0), weights);
  EXPECT_NEAR(w[6], 0.0, 1e-3);
  EXPECT_NEAR(w[7], 0.0, 1e-3);
  EXPECT_EQ(w[5], 1.0);
  EXPECT_EQ(w[8], 1.0);
  EXPECT_EQ(w[0], 0.0);
}

TEST_F(YawChainTest, SlidingAPostureKeepsItsTotalBendInsideTheBody) {
  const LinkArray shape = u_shape(1.0);
  for (double distance_m = 0.0; distance_m < 5.0 * 0.178; distance_m += 0.013) {
    const LinkArray moved = chain.slid(shape, distance_m);
    double total = 0.0;
    for (std::size_t k = 0; k < chain.joint_count(); ++k) total += moved[k];
    EXPECT_NEAR(total, std::numbers::pi, 1e-9) << distance_m;
  }
  const LinkArray outside = chain.slid(shape, 8.0 * 0.178);
  for (std::size_t k = 0; k < chain.joint_count(); ++k) EXPECT_NEAR(outside[k], 0.0, 1e-12);
}

}  // namespace
}  // namespace constrictor
