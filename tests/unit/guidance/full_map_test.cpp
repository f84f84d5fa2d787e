// More objects and zones than the map has room for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "guidance/guidance.hpp"
#include "mapping.hpp"
#include "still_plant.hpp"
#include "support/scripted_members.hpp"

namespace constrictor {
namespace {

using testing::Mapping;

/// Objects and zones, in so many different places that none is taken for another one that has moved.
std::vector<msg::Blob> many(int count) {
  std::vector<msg::Blob> blobs;
  for (const std::uint8_t kind : {msg::kBlobObject, msg::kBlobZone}) {
    for (std::uint8_t colour = msg::kColourGreen; colour < msg::kColourCount; ++colour) {
      for (const double y : {-1.2, 0.0, 1.2}) blobs.push_back(Mapping::blob(colour, kind, 1.0 + 0.1 * colour, y, 0.08));
    }
  }
  blobs.resize(static_cast<std::size_t>(count));
  return blobs;
}

bool has(const msg::FieldMap& map, const msg::Blob& blob) {
  const double x = (blob.range_m + 0.08) * std::cos(blob.bearing_rad);
  const double y = (blob.range_m + 0.08) * std::sin(blob.bearing_rad);
  return std::any_of(map.objects, map.objects + map.object_count, [&](const msg::MapObject& object) {
    return object.colour == blob.colour && object.kind == blob.kind && std::hypot(object.x_m - x, object.y_m - y) < 0.1;
  });
}

TEST(FullMap, AnUnconfirmedLandmarkGivesWayToANewObject) {
  Mapping m;
  auto seen = many(18);
  const msg::Blob last = seen[17], phantom = seen[16];
  seen.resize(15);
  m.look(seen, 5);
  ASSERT_EQ(m.map().object_count, 15);
  m.look({phantom}, 1);
  EXPECT_EQ(m.state.landmarks.size(), 16U);
  m.look({last}, 3);
  EXPECT_TRUE(has(m.map(), last));
  EXPECT_EQ(m.map().object_count, 16);
  EXPECT_FALSE(has(m.map(), phantom));
  EXPECT_FALSE(m.mapper.left_out());
  EXPECT_EQ(m.filter.landmark_count(), 16U) << "the filter has forgotten the phantom, too";
}

TEST(FullMap, OfTheUnconfirmedLandmarksTheOneNotSeenForTheLongestTimeGivesWay) {
  Mapping m;
  auto seen = many(17);
  const msg::Blob last = seen[16], early = seen[15], late = seen[14];
  seen.resize(14);
  m.look(seen, 5);
  m.look({early}, 2);
  m.look({late}, 1);
  m.look({last}, 3);
  EXPECT_TRUE(has(m.map(), last));
  m.look({late}, 2);
  EXPECT_TRUE(has(m.map(), late)) << "its first percept still counts";
}

TEST(FullMap, AnImageDoesNotForgetWhatItShows) {
  Mapping m;
  const auto all = many(24);
  m.look({all.begin(), all.begin() + 12}, 5);
  const std::vector<msg::Blob> others(all.begin() + 12, all.end());
  m.look(others, 2);
  EXPECT_EQ(m.state.landmarks.size(), 16U);
  EXPECT_FALSE(m.mapper.left_out()) << "four of the 16 may give way yet";
  m.look(others, 2);
  EXPECT_EQ(m.map().object_count, 16);
  for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(has(m.map(), all[i]), i < 16) << i;
  ASSERT_TRUE(m.mapper.left_out());
  EXPECT_EQ(m.mapper.left_out()->colour, all[16].colour);
  EXPECT_EQ(m.mapper.left_out()->kind, all[16].kind);
}

/// Shows 16 objects and zones in each image; from tick 50 on, another one instead of the last.
class Crowd : public StatefulComponent<std::int64_t> {
 public:
  Crowd(Wiring& wiring, const Setup&) : objects_(wiring.output(topics::kObjectPercepts)) {}
  [[nodiscard]] Timing timing() const override { return {5, 1}; }
  void step(const Tick& tick) override {
    msg::ObjectPercepts objects{};
    objects.exposure_tick = tick.index - 2;
    const auto blobs = many(17);
    std::copy(blobs.begin(), blobs.begin() + 16, objects.blobs);
    objects.blob_count = 16;
    if (tick.index >= 50) objects.blobs[15] = blobs[16];
    objects_.write(objects);
  }

 private:
  Output<msg::ObjectPercepts> objects_;
};

TEST(FullMap, WhatIsLeftOutIsReportedOnce) {
  constrictor::Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  LocalRun run({testing::still_plant(), testing::member_of_class<Crowd>("perception"), make_guidance_factory()}, setup);
  run.advance(50);
  EXPECT_EQ(run.latest(topics::kFieldMap)->object_count, 16);
  EXPECT_EQ(run.member("guidance").counters().refused, 0U);
  run.advance(100);
  EXPECT_EQ(run.member("guidance").counters().refused, 1U) << "the images that follow are no news";
  EXPECT_EQ(run.member("guidance").counters().last_refusal,
            "perception/objects: found a new object or zone, accepted at most 16 in the map");
}

}  // namespace
}  // namespace constrictor
