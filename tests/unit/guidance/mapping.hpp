// A map whose percepts the test makes.
#pragma once

#include <array>
#include <cmath>
#include <initializer_list>
#include <vector>

#include "guidance/field_mapper.hpp"
#include "robot/planar.hpp"
#include "snake.hpp"

namespace constrictor::testing {

/// A map; the robot stands at the origin.
struct Mapping {
  RobotModel model = snake();
  guidance::GuidanceConfig config;
  guidance::FieldState state;
  guidance::PoseFilterState filter_state;
  guidance::PoseFilter filter{filter_state};
  guidance::FieldMapper mapper{state, filter, model, config};
  std::array<double, 23> q{};
  std::int64_t tick = 0;
  bool level = true;

  static msg::Blob blob(std::uint8_t colour, std::uint8_t kind, double x, double y, double radius) {
    msg::Blob b{};
    b.colour = colour;
    b.kind = kind;
    b.object_probability = kind == msg::kBlobObject ? 0.99 : kind == msg::kBlobZone ? 0.01 : 0.5;
    b.bearing_rad = std::atan2(y, x);
    b.range_m = std::hypot(x, y) - radius;
    b.width_m = 2.0 * radius;
    return b;
  }
  void see(std::initializer_list<msg::Blob> blobs, int times = 1, const PlanarPose& exposure = {}) {
    msg::ObjectPercepts percepts{};
    for (const msg::Blob& b : blobs) percepts.blobs[percepts.blob_count++] = b;
    for (int i = 0; i < times; ++i) mapper.objects(percepts, exposure, tick += 5);
  }
  /// The same for images whose missing landmarks are doubted.
  void look(const std::vector<msg::Blob>& blobs, int times) {
    msg::ObjectPercepts percepts{};
    for (const msg::Blob& b : blobs) percepts.blobs[percepts.blob_count++] = b;
    for (int i = 0; i < times; ++i) {
      mapper.objects(percepts, {}, tick += 5);
      mapper.doubt(percepts, {}, chain(), level, tick, 0.02);
    }
  }
  [[nodiscard]] guidance::BodyChain chain() const { return planar_module_poses(model, q); }
  [[nodiscard]] msg::FieldMap map() const {
    msg::FieldMap m{};
    mapper.fill(m);
    return m;
  }
};

}  // namespace constrictor::testing
