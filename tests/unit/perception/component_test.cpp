// The component in a run: it uses the head's attitude at the exposure and the task's colours, refuses broken images,
// and can be restarted.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "constrictor/text.hpp"
#include "faults/faulty_component.hpp"
#include "perception/perception.hpp"
#include "ray_caster.hpp"
#include "support/scripted_members.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

using testing::Arc;
using testing::Head;

/// The head nods quickly: an image can be understood only with the attitude at its exposure.
Head head_at(std::int64_t tick) {
  Head head;
  head.pitch_rad = 0.05 * std::sin(1.3 * static_cast<double>(tick));
  head.yaw_rad = 0.01 * static_cast<double>(tick);
  return head;
}

/// The plant: an inertial unit in the head.
ComponentFactory imu() {
  return testing::scripted_plant([](Wiring& wiring) -> testing::StepFunction {
    return [out = wiring.output(topics::kImuState)](const Tick& tick) {
      msg::ImuState state{};
      state.orientation = testing::orientation(head_at(tick.index));
      out.write(state);
    };
  });
}

/// The camera: images of a blue line and a yellow cylinder. The image of tick 15 lacks most of its bytes.
class Eye : public StatefulComponent<std::int64_t> {
 public:
  Eye(Wiring& wiring, const Setup&)
      : info_(wiring.output(topics::kCameraInfo)), image_(wiring.output(topics::kCameraImage)) {}
  [[nodiscard]] Timing timing() const override { return {5, 2}; }
  void step(const Tick& tick) override {
    const msg::CameraInfo info = testing::camera_info(160, 120);
    if (tick.index == 0) info_.write(info);
    testing::Scene scene;
    scene.line = Arc{{-0.2, 0.08}, 0.0, 0.0};
    scene.rounds = {{msg::kColourYellow, {0.8, -0.3}, 0.08, 0.15}};
    cv::Mat picture = testing::draw(scene, info, head_at(tick.index));
    msg::CameraImage image{};
    image.width = info.width;
    image.height = info.height;
    image.exposure_tick = tick.index;
    image.data._buffer = picture.data;
    image.data._length = image.data._maximum = tick.index == 15 ? 100 : 160 * 120 * 3;
    image_.write(image);
  }

 private:
  Output<msg::CameraInfo> info_;
  Output<msg::CameraImage> image_;
};

/// Stands for navigation: a task names a yellow line at tick 30.
ComponentFactory tasks() {
  return testing::scripted_writer<msg::TaskStatus>("navigation", topics::kTaskStatus,
                                                   [](const Tick& tick, const auto& out) {
                                                     msg::TaskStatus status{};
                                                     if (tick.index == 30)
                                                       status.parameters.line_colour = msg::kColourYellow;
                                                     out.write(status);
                                                   });
}

/// Stands for the component `input`: changes the hues that count as yellow, so that the cylinder is no longer yellow,
/// and later changes them back. Each change is requested some ticks before it comes into force.
class Desk : public StatefulComponent<int> {
 public:
  // Ticks of the two changes. The image of tick 20 arrives at tick 22, and the image of tick 40 at tick 42.
  static constexpr std::int64_t kGone = 22, kBack = 43;
  Desk(Wiring& wiring, const Setup&) : change_(wiring.output(topics::kParameterChange)) {}
  void step(const Tick& tick) override {
    if (tick.index == 10) change("perception.colour.yellow.from_deg", 71.0, kGone);
    if (tick.index == 30) change("perception.colour.yellow.from_deg", 42.0, kBack);
  }

 private:
  void change(const char* name, double value, std::int64_t tick) {
    msg::ParameterChange message{};
    set_text(message.source, "test");
    set_text(message.name, name);
    message.value = value;
    message.effective_tick = tick;
    change_.write(message);
  }
  Output<msg::ParameterChange> change_;
};

std::unique_ptr<LocalRun> make_run(bool with_changes = false, const std::filesystem::path& config = {}) {
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  std::vector<ComponentFactory> factories{imu(), testing::member_of_class<Eye>("camera"), tasks(),
                                          make_perception_factory()};
  if (with_changes) factories.push_back(testing::member_of_class<Desk>("input"));
  return std::make_unique<LocalRun>(factories, setup,
                                    std::map<std::string, std::filesystem::path>{{"perception", config}});
}

TEST(PerceptionComponent, AFrozenCameraIsNoticedAndForgivenWhenItGoesOn) {
  auto plan = std::make_shared<FaultPlan>();
  TopicFault freeze;
  freeze.kind = TopicFault::Kind::kFreeze;
  freeze.topic = &topics::kInfos[topics::kCameraImage.id];
  freeze.from_ns = 500'000'000;     // tick 25
  freeze.until_ns = 1'200'000'000;  // tick 60
  plan->topics = {freeze};
  constrictor::Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  LocalRun run({imu(), testing::member_of_class<Eye>("camera"), tasks(), with_faults(make_perception_factory(), plan)},
               setup);
  std::vector<std::int64_t> seen;
  run.subscribe<msg::LinePercept>(topics::kLinePercept,
                                  [&](const msg::LinePercept& line) { seen.push_back(line.exposure_tick); });
  run.advance(80);
  // The image of tick 15 is broken. Three equal images in a row are accepted, because a camera may send one of them
  // again.
  EXPECT_EQ(seen, (std::vector<std::int64_t>{0, 5, 10, 20, 20, 20, 60, 65, 70, 75}));
  EXPECT_EQ(run.member("perception").counters().last_refusal,
            "camera/image: found the same bytes in 8 images, accepted at most 3; the camera is frozen");
}

TEST(PerceptionComponent, UsesTheAttitudeOfTheExposure) {
  auto run = make_run();
  int percepts = 0;
  run->subscribe<msg::LinePercept>(topics::kLinePercept, [&](const msg::LinePercept& line) {
    if (line.colour != msg::kColourBlue) return;
    ++percepts;
    EXPECT_EQ(line.exposure_tick % 5, 0);
    EXPECT_EQ(line.header.tick, line.exposure_tick + 2);  // when the image became visible
    ASSERT_TRUE(line.visible);
    EXPECT_NEAR(line.offset_m, 0.08, 0.015);
    EXPECT_NEAR(line.heading_rad, 0.0, 0.06);
  });
  run->advance(30);
  EXPECT_EQ(percepts, 5);  // exposures at ticks 0, 5, 10, 20 and 25; the image of tick 15 is broken
  EXPECT_EQ(run->member("perception").counters().refused, 1u);
  EXPECT_EQ(run->member("perception").counters().last_refusal,
            "camera/image: data: found 100 bytes, accepted 160 x 120 x 3 = 57600");
  ASSERT_NE(run->latest(topics::kProcessedImage), nullptr);
  EXPECT_EQ(run->latest(topics::kProcessedImage)->data._length, 160u * 120u * 3u);
}

TEST(PerceptionComponent, SearchesForTheColourThatATaskNamedLast) {
  auto run = make_run();
  run->advance(28);
  EXPECT_EQ(run->latest(topics::kLinePercept)->colour, msg::kColourBlue);
  run->advance(20);
  EXPECT_EQ(run->latest(topics::kLinePercept)->colour, msg::kColourYellow);
  EXPECT_FALSE(run->latest(topics::kLinePercept)->visible);  // a yellow cylinder is not a line
}

TEST(PerceptionComponent, RestartChangesNothing) {
  auto whole = make_run(), broken = make_run();
  whole->advance(50);
  for (int i = 0; i < 50; ++i) {
    broken->advance(1);
    if (i == 11 || i == 33 || i == 34) broken->restart("perception");
  }
  EXPECT_EQ(whole->output_hashes(), broken->output_hashes());
}

TEST(PerceptionComponent, ErrorsAreAddedToWhatItWritesAndRepeatedAfterARestart) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "perception.yaml";
  std::ofstream(file) << "error: {line_noise_m: 0.05, false_share: 0.5, missed_line_share: 0.3}\n";
  auto clean = make_run(), whole = make_run(false, file), broken = make_run(false, file);
  std::vector<double> offsets;
  int lost = 0, invented = 0;
  whole->subscribe<msg::LinePercept>(topics::kLinePercept, [&](const msg::LinePercept& line) {
    if (line.visible) offsets.push_back(line.offset_m);
    else ++lost;
  });
  whole->subscribe<msg::ObjectPercepts>(topics::kObjectPercepts, [&](const msg::ObjectPercepts& objects) {
    for (int i = 0; i < objects.blob_count; ++i) invented += objects.blobs[i].colour != msg::kColourYellow;
  });
  for (auto* run : {&clean, &whole}) (*run)->advance(30);  // then a task names another line
  for (int i = 0; i < 30; ++i) {
    if (i == 11 || i == 26) broken->restart("perception");
    broken->advance(1);
  }
  EXPECT_NE(clean->output_hashes().at("perception"), whole->output_hashes().at("perception"));
  EXPECT_EQ(whole->output_hashes(), broken->output_hashes());
  ASSERT_GE(offsets.size(), 2u);
  EXPECT_GT(*std::max_element(offsets.begin(), offsets.end()) - *std::min_element(offsets.begin(), offsets.end()),
            0.02);
  EXPECT_EQ(static_cast<int>(offsets.size()) + lost, 5);  // images
  EXPECT_GE(invented, 1);
}

/// Ticks of the exposures in which the yellow cylinder was reported (first set) and was not reported (second set).
std::pair<std::set<std::int64_t>, std::set<std::int64_t>> yellow_seen(LocalRun& run, std::int64_t ticks,
                                                                      const std::set<std::int64_t>& restarts) {
  std::pair<std::set<std::int64_t>, std::set<std::int64_t>> seen;
  run.subscribe<msg::ObjectPercepts>(topics::kObjectPercepts, [&seen](const msg::ObjectPercepts& percepts) {
    bool yellow = false;
    for (int i = 0; i < percepts.blob_count; ++i) yellow = yellow || percepts.blobs[i].colour == msg::kColourYellow;
    (yellow ? seen.first : seen.second).insert(percepts.exposure_tick);
  });
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    if (restarts.contains(tick)) run.restart("perception");
    run.advance(1);
  }
  return seen;
}

TEST(PerceptionComponent, AppliesAHueFromItsTickOnAlsoAfterARestart) {
  using Exposures = std::set<std::int64_t>;
  const Exposures before_and_after{0, 5, 10, 45, 50, 55},
      between{20, 25, 30, 35, 40};  // the image of tick 15 is broken
  // Restart while the change is requested but not in force, while it is in force, and after it was taken back.
  for (const Exposures& restarts : {Exposures{}, Exposures{12, 22}, Exposures{23, 28, 42}, Exposures{44, 50}}) {
    auto run = make_run(true);
    const auto seen = yellow_seen(*run, 60, restarts);
    EXPECT_EQ(seen.first, before_and_after);
    EXPECT_EQ(seen.second, between);
  }
}

TEST(PerceptionComponent, RefusesImagesThatDoNotFitTheCamera) {
  const msg::CameraInfo info = testing::camera_info();
  std::vector<std::uint8_t> data(320 * 240 * 3);
  msg::CameraImage image{};
  image.width = 320;
  image.height = 240;
  image.data._buffer = data.data();
  image.data._length = static_cast<std::uint32_t>(data.size());
  EXPECT_EQ(perception::image_error(image, info), "");
  image.data._length -= 1;
  EXPECT_NE(perception::image_error(image, info), "");
  image.data._length += 1;
  image.width = 240;
  image.height = 320;
  EXPECT_NE(perception::image_error(image, info), "");
  image.width = 320;
  image.height = 240;
  msg::CameraInfo blind = info;
  blind.fx = std::nan("");
  EXPECT_NE(perception::image_error(image, blind), "");
  // A model that no camera has would let a line's cross-section have billions of points.
  const auto refused = [&](auto change) {
    msg::CameraInfo other = info;
    change(other);
    return !perception::image_error(image, other).empty();
  };
  EXPECT_TRUE(refused([](msg::CameraInfo& i) { i.fx = 1e-9; }));
  EXPECT_TRUE(refused([](msg::CameraInfo& i) { i.fy = 1e9; }));
  EXPECT_TRUE(refused([](msg::CameraInfo& i) { i.cx = 1e6; }));
  EXPECT_TRUE(refused([](msg::CameraInfo& i) { i.X_HC.position_m.z = 1e5; }));
  EXPECT_TRUE(refused([](msg::CameraInfo& i) { i.X_HC.orientation = {0.0, 0.0, 0.0, 0.0}; }));
  EXPECT_FALSE(refused([](msg::CameraInfo& i) { i.fx = i.fy = 0.1 * i.width; }));
}

}  // namespace
}  // namespace constrictor
