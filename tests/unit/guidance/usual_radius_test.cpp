// What the map assumes of objects and zones whose width no image has shown.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "component/component.hpp"
#include "mapping.hpp"

namespace constrictor {
namespace {

using namespace guidance;
using testing::Mapping;

/// A blob of unknown width straight ahead.
msg::Blob unmeasured(std::uint8_t kind, double range_m) {
  msg::Blob blob = Mapping::blob(msg::kColourGreen, kind, range_m, 0.0, 0.0);
  blob.width_m = std::numeric_limits<double>::quiet_NaN();
  return blob;
}

TEST(UsualRadius, IsTheOneThatTheMissionStates) {
  constrictor::Setup setup;
  EXPECT_EQ(load_configuration<GuidanceConfig>(setup).object_radius_m, 0.085);
  EXPECT_EQ(load_configuration<GuidanceConfig>(setup).zone_radius_m, 0.3);
  setup.mission = "{sequence: [green], line_colour: blue, known: {object_radius_m: 0.12, zone_radius_m: 0.5}}";
  EXPECT_EQ(load_configuration<GuidanceConfig>(setup).object_radius_m, 0.12);
  EXPECT_EQ(load_configuration<GuidanceConfig>(setup).zone_radius_m, 0.5);
}

TEST(UsualRadius, LeadsFromTheNearEdgeToTheCentre) {
  for (const std::uint8_t kind : {msg::kBlobObject, msg::kBlobZone}) {
    Mapping m;
    m.config.object_radius_m = 0.12;
    m.config.zone_radius_m = 0.5;
    m.see({unmeasured(kind, 0.8)}, 5);
    ASSERT_EQ(m.map().object_count, 1);
    EXPECT_NEAR(m.map().objects[0].x_m, kind == msg::kBlobObject ? 0.92 : 1.3, 1e-6);
  }
}

TEST(UsualRadius, PlacesTheHeldObjectBeforeTheBaseOfTheU) {
  const auto held_at = [](double radius_m) {
    Mapping m;
    m.config.object_radius_m = radius_m;
    m.see({unmeasured(msg::kBlobObject, 0.1)}, 5);
    for (const std::size_t i : {8U, 10U, 12U}) m.q[i] = std::numbers::pi / 3.0;
    msg::TaskStatus task{};
    task.carrying = true;
    task.parameters.object_handle = 1;
    m.mapper.carry(task, m.chain(), m.tick);
    EXPECT_TRUE(m.map().objects[0].carried);
    return Eigen::Vector2d(m.map().objects[0].x_m, m.map().objects[0].y_m);
  };
  EXPECT_NEAR((held_at(0.12) - held_at(0.085)).norm(), 0.035, 1e-9);
}

// The lower border of the image always cut the zone, so that its width stayed unknown. It was taken for a disc as small
// as an object, which such an image would show, and left the map.
TEST(UsualRadius, AZoneIsNotDoubtedWhereItReachesBelowTheImage) {
  Mapping m;
  msg::Blob zone = Mapping::blob(msg::kColourGreen, msg::kBlobZone, 0.55, 0.0, 0.3);
  zone.cut_bottom = true;
  m.look({zone}, 20);
  ASSERT_EQ(m.map().object_count, 1);
  EXPECT_TRUE(std::isnan(m.map().objects[0].radius_m));
  m.look({}, 100);
  EXPECT_EQ(m.map().object_count, 1);
}

}  // namespace
}  // namespace constrictor
