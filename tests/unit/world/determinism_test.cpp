// Equal commands give equal states, bit for bit.
#include <gtest/gtest.h>

#include <openssl/evp.h>

#include <cstring>

#include "unit/world/world_fixture.hpp"

namespace constrictor {
namespace {

class Determinism : public EachEngine {};
INSTANTIATE_TEST_SUITE_P(Engines, Determinism, kEngines, engine_name);

Scenario busy_scene() {
  Scenario scenario;
  ScenarioObject object;
  object.position_m = {0.5, 0.1};
  scenario.objects.push_back(object);
  object.position_m = {0.75, 0.1};
  object.shape = BodyShape::kBox;
  object.size_m = {0.1, 0.2, 0.15};
  scenario.objects.push_back(object);
  return scenario;
}

StateHash::Digest run_alone(const SolverSettings& settings, const OpenLoopGait& gait, int ticks) {
  World world(mamba(), busy_scene(), settings);
  for (int tick = 0; tick < ticks; ++tick) gait.drive(world, tick * kPeriod_s, kPeriod_s);
  return world.state_hash();
}

TEST_P(Determinism, WorldsThatTakeTurnsEqualWorldsThatRunAlone) {
  OpenLoopGait forward;
  OpenLoopGait turning;
  turning.curvature_1_m = 0.8;
  World first(mamba(), busy_scene(), settings());
  World second(mamba(), busy_scene(), settings());
  for (int tick = 0; tick < 60; ++tick) {
    forward.drive(first, tick * kPeriod_s, kPeriod_s);
    turning.drive(second, tick * kPeriod_s, kPeriod_s);
  }
  EXPECT_EQ(first.state_hash(), run_alone(settings(), forward, 60));
  EXPECT_EQ(second.state_hash(), run_alone(settings(), turning, 60));
  EXPECT_NE(first.state_hash(), second.state_hash());
}

TEST_P(Determinism, TheRobotPushesAnObjectIntoAnother) {
  // Both objects of busy_scene() move, so the test above covers contacts between objects.
  World world(mamba(), busy_scene(), settings());
  OpenLoopGait gait;
  for (int tick = 0; tick < 120; ++tick) gait.drive(world, tick * kPeriod_s, kPeriod_s);
  EXPECT_GT(world.object_pose(0).translation().x(), 0.55);
  EXPECT_GT((world.object_pose(1).translation().head<2>() - Eigen::Vector2d(0.75, 0.1)).norm(), 0.02);
}

TEST(StateHash, IsTheChainOfSha256) {
  const std::vector<double> first = {1.5, -2.0};
  const std::vector<double> second = {3.0};
  StateHash hash;
  hash.extend(first);
  hash.extend(second);
  // The same chain with the incremental interface of OpenSSL.
  std::array<std::uint8_t, 32> expected{};
  for (const auto* values : {&first, &second}) {
    EVP_MD_CTX* context = EVP_MD_CTX_new();
    EVP_DigestInit_ex(context, EVP_sha256(), nullptr);
    EVP_DigestUpdate(context, expected.data(), expected.size());
    for (const double value : *values) EVP_DigestUpdate(context, &value, sizeof(value));
    EVP_DigestFinal_ex(context, expected.data(), nullptr);
    EVP_MD_CTX_free(context);
  }
  EXPECT_EQ(hash.digest(), expected);
}

}  // namespace
}  // namespace constrictor
