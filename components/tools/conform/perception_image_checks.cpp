// Whether each image is answered once, in time and with its own stamp; images that show nothing, and images that must
// be refused.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <iterator>

#include "configuration/counted.hpp"
#include "conform/part_restart.hpp"
#include "conform/perception_conformance.hpp"

namespace constrictor::conform {

std::vector<Check> perception_checks() {
  return {
      {"arrives", "perception/line and perception/objects follow the first image", {}, {}, {}},
      {"every_image", "each image is answered once on each topic", {}, {}, {}},
      {"stamp", "exposure_tick of the percepts is that of their image", {}, {}, {}},
      {"answer", "the percepts follow their image in time", {}, {}, {}},
      {"picture", "perception/image has the size and the exposure_tick of its image", {}, {}, {}},
      {"empty", "nothing is seen on grey ground", {}, {}, {}},
      {"black", "nothing is seen in a black image", {}, {}, {}},
      {"noise", "nothing is seen in strong noise", {}, {}, {}},
      {"line", "a line of the task's colour is seen", {}, {}, {}},
      {"line_sign", "offset_m of a line on the left is positive", {}, {}, {}},
      {"line_offset", "offset_m is the lateral position of the line at lookahead_m, in metres", {}, {}, {}},
      {"line_heading", "heading_rad is the direction of the line there, positive left", {}, {}, {}},
      {"line_curvature", "curvature_1_m is positive where the line bends left", {}, {}, {}},
      {"line_points", "the points lie on the line, near to far, x ahead and y to the left", {}, {}, {}},
      {"line_end", "the end of the line ahead is seen, and its distance", {}, {}, {}},
      {"attitude", "the attitude of the head at the exposure is taken into account", {}, {}, {}},
      {"line_colour", "the line has the colour that the task names; others are not the line", {}, {}, {}},
      {"object", "an object on the ground is seen once", {}, {}, {}},
      {"object_colour", "the colour of an object is named", {}, {}, {}},
      {"object_kind", "what stands up is an object, what lies flat is a zone", {}, {}, {}},
      {"object_probability", "the probability of an object agrees with the kind", {}, {}, {}},
      {"bearing_sign", "the bearing of an object on the left is positive", {}, {}, {}},
      {"bearing", "bearing_rad is the direction from the head to the object", {}, {}, {}},
      {"range", "range_m is the distance from the head to the nearest ground point", {}, {}, {}},
      {"width", "width_m is the visible width", {}, {}, {}},
      {"height", "height_m is the height of an object above the ground", {}, {}, {}},
      {"largest_first", "of several objects the largest in the image comes first", {}, {}, {}},
      {"box", "the bounding box contains the object, in pixels from the top left corner", {}, {}, {}},
      {"cut", "the border of the image that cuts an object is named", {}, {}, {}},
      {"wrong_size", "an image of another size than camera/info is not used, and counted as refused", {}, {}, {}},
      {"bad_model", "no image is used while camera/info has no focal length", {}, {}, {}},
      {"frozen", "images that are equal for long are refused, and the next other one is used", {}, {}, {}},
      {"epoch", "a new epoch begins without memory", {}, {}, {}},
      {"repeatable", "the same images give the same percepts in the next epoch, bit for bit", {}, {}, {}},
      restart_check(),
  };
}

void PerceptionConformance::run() {
  if (!check_arrival()) {
    report_.skip_rest("perception writes nothing that could be checked");
    return;
  }
  check_nothing();
  check_line();
  check_line_shape();
  check_line_end();
  check_line_colour();
  check_objects();
  check_bearing();
  check_size();
  check_image_border();
  check_refusals();
  check_epoch();
}

const msg::LinePercept* PerceptionConformance::line_of(const SyntheticScene& scene) {
  shown_ = hand_.show(scene);
  return shown_.back().lines.empty() ? nullptr : &shown_.back().lines.back();
}

const msg::ObjectPercepts* PerceptionConformance::objects_of(const SyntheticScene& scene) {
  shown_ = hand_.show(scene);
  return shown_.back().objects.empty() ? nullptr : &shown_.back().objects.back();
}

bool PerceptionConformance::check_arrival() {
  SyntheticScene scene;
  scene.line = PaintedLine{};
  shown_ = hand_.show(scene, 10);
  const bool arrived = std::any_of(shown_.begin(), shown_.end(), [](const Seen& seen) { return seen.answered(); });
  report_.judge("arrives", !arrived,
                arrived ? "after " + counted(shown_.front().answer_ticks, "tick")
                        : "no answer to " + counted(shown_.size(), "image"),
                "write both topics for each image, as soon as camera/info has arrived; the run refuses values that are "
                "not finite or out of range, and its log names them");
  if (!arrived) return false;
  // The first image may lack an answer, because it arrives together with the model of the camera.
  std::size_t answers = 0;
  std::int64_t slowest_ticks = 0;
  std::string stamp, picture;
  std::size_t pictures = 0;
  const msg::CameraInfo model = hand_.camera().info();
  for (const Seen& seen : shown_) {
    answers += seen.lines.size() == 1 && seen.objects.size() == 1;
    slowest_ticks = std::max(slowest_ticks, seen.answer_ticks);
    for (const auto& line : seen.lines) {
      if (line.exposure_tick != seen.exposure_tick)
        stamp = fmt::format("perception/line has exposure_tick {} for an image of tick {}", line.exposure_tick,
                            seen.exposure_tick);
    }
    for (const auto& objects : seen.objects) {
      if (objects.exposure_tick != seen.exposure_tick)
        stamp = fmt::format("perception/objects has exposure_tick {} for an image of tick {}", objects.exposure_tick,
                            seen.exposure_tick);
    }
    for (const auto& one : seen.pictures) {
      ++pictures;
      if (one.width != model.width || one.height != model.height || one.exposure_tick != seen.exposure_tick)
        picture = fmt::format("perception/image is {} x {} of tick {}, for an image of {} x {} of tick {}", one.width,
                              one.height, one.exposure_tick, model.width, model.height, seen.exposure_tick);
    }
  }
  report_.judge("every_image", answers + 1 < shown_.size(),
                fmt::format("{} of {} images are answered once on each topic", answers, shown_.size()),
                "answer each image, also if nothing is seen in it");
  report_.pass_unless("stamp", stamp, "that of the image",
                      "copy CameraImage.exposure_tick; guidance takes the pose of that tick");
  const double slowest_s = kTick_s * static_cast<double>(slowest_ticks);
  report_.judge("answer", slowest_s > profile_.answer_s, fmt::format("{:.2f} s at most", slowest_s),
                fmt::format("be faster than {} s, or change answer_s of the profile", profile_.answer_s));
  if (pictures == 0) report_.skip("picture", "perception writes no perception/image");
  else report_.pass_unless("picture", picture, counted(pictures, "image"), "draw into a copy of the image");
  return true;
}

void PerceptionConformance::check_nothing() {
  const auto sees_nothing = [&](const char* name, const SyntheticScene& scene, const char* todo) {
    std::string seen;
    for (const Seen& one : hand_.show(scene)) {
      for (const auto& line : one.lines) {
        if (line.visible) seen = fmt::format("a line {:.2f} m to the left", line.offset_m);
      }
      for (const auto& objects : one.objects) {
        if (objects.blob_count > 0) seen = fmt::format("{} objects or zones", objects.blob_count);
      }
    }
    report_.pass_unless(name, seen, "nothing is seen", todo);
  };
  SyntheticScene scene;
  sees_nothing("empty", scene, "set visible to false and blob_count to 0");
  scene.light = 0.0;
  sees_nothing("black", scene, "demand a least brightness of coloured pixels");
  scene.light = 1.0;
  scene.noise = 0.06;
  sees_nothing("noise", scene, "smooth the image, and drop specks");
}

void PerceptionConformance::check_refusals() {
  const msg::CameraInfo model = hand_.camera().info();
  SyntheticScene scene;
  scene.line = PaintedLine{};
  std::vector<std::uint8_t> rgb = hand_.camera().draw(scene);
  std::uint64_t seed = 1'000'000;
  const auto noisy = [&] {
    std::vector<std::uint8_t> copy = rgb;
    SyntheticCamera::add_noise(copy, 0.01, ++seed);
    return copy;
  };
  /// Shows images; judges by the answers to the last ones, by the count of refusals and by what comes afterwards.
  const auto refuses = [&](const char* name, const std::function<Seen()>& show_wrong, int wrong, int allowed,
                           const std::function<void()>& repair, const char* todo) {
    hand_.wait(PartPort::kStatusTicks);
    const std::uint64_t before = port_.refused();
    int used = 0;
    for (int i = 0; i < wrong; ++i) {
      const Seen seen = show_wrong();
      used += i >= allowed && (!seen.lines.empty() || !seen.objects.empty());
    }
    repair();
    const Seen again = hand_.show(noisy(), model.width, model.height);
    hand_.wait(PartPort::kStatusTicks);
    const std::uint64_t counted = port_.refused() - before;
    report_.judge(name, used > 0 || counted == 0 || !again.answered(),
                  used > 0            ? fmt::format("{} of them are used", used)
                  : counted == 0      ? std::string("nothing is counted as refused")
                  : !again.answered() ? std::string("a right image afterwards is not used either")
                                      : fmt::format("{} refused", counted),
                  todo);
  };
  const auto nothing = [] {};
  refuses(
      "wrong_size",
      [&] {
        std::vector<std::uint8_t> half(static_cast<std::size_t>(model.width / 2) * (model.height / 2) * 3, 100);
        SyntheticCamera::add_noise(half, 0.01, ++seed);
        return hand_.show(std::move(half), model.width / 2, model.height / 2);
      },
      3, 0, nothing, "compare the size with camera/info before any pixel is read, and count the image (count_refusal)");
  hand_.info = model;
  hand_.info->fx = hand_.info->fy = 0.0;
  // The model may become visible one tick after the first image.
  refuses(
      "bad_model", [&] { return hand_.show(noisy(), model.width, model.height); }, 4, 1, [&] { hand_.info = model; },
      "demand focal lengths that a camera can have, and count the image (count_refusal)");
  if (profile_.frozen_after == 0) return report_.skip("frozen", "frozen_after of the profile is 0");
  const std::vector<std::uint8_t> same = noisy();
  refuses(
      "frozen", [&] { return hand_.show(same, model.width, model.height); }, profile_.frozen_after + 5,
      profile_.frozen_after, nothing,
      "compare images: the noise of any camera makes them different. Count those that are equal as refused");
}

namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// How the answers to the same images differ; empty: they do not.
std::string difference(const std::vector<Seen>& first, const std::vector<Seen>& second) {
  for (std::size_t i = 0; i < std::min(first.size(), second.size()); ++i) {
    const Seen &a = first[i], &b = second[i];
    if (a.lines.size() != b.lines.size() || a.objects.size() != b.objects.size())
      return fmt::format("another number of answers to image {}", i);
    for (std::size_t k = 0; k < a.lines.size(); ++k) {
      if (!same_bits(a.lines[k].offset_m, b.lines[k].offset_m) ||
          !std::equal(std::begin(a.lines[k].y_m), std::end(a.lines[k].y_m), b.lines[k].y_m, same_bits))
        return fmt::format("another line in image {}", i);
    }
    for (std::size_t k = 0; k < a.objects.size(); ++k) {
      const auto &one = a.objects[k], &other = b.objects[k];
      if (one.blob_count != other.blob_count || !same_bits(one.blobs[0].range_m, other.blobs[0].range_m))
        return fmt::format("other objects in image {}", i);
    }
  }
  return {};
}

}  // namespace

void PerceptionConformance::check_epoch() {
  const auto play = [&](const std::function<void()>& disturb) {
    hand_.begin_epoch();
    SyntheticScene scene;
    scene.line = PaintedLine{};
    scene.line->begin_y_m = 0.05;
    scene.standing = {{msg::kColourRed, 1.0, -0.3, 0.08, 0.15}};
    std::vector<Seen> all = hand_.show(scene, 2);
    disturb();
    for (Seen& seen : hand_.show(scene, 2)) all.push_back(std::move(seen));
    return all;
  };
  const std::vector<Seen> first = play([] {}), second = play([] {});
  const bool answered = first.back().answered() && second.back().answered();
  report_.judge("epoch", !answered, answered ? "images are answered" : "no answer in the new epoch",
                "construct the component anew at each EpochStart");
  judge_repetitions(
      report_, port_, difference(first, second),
      [&](const std::function<void()>& disturb) { return difference(first, play(disturb)); },
      fmt::format("{} images give the same", first.size()),
      "read no clock, use one thread, and draw random numbers only from a generator with the run's seed");
}

}  // namespace constrictor::conform
