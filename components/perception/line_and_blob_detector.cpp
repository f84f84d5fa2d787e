#include "perception/line_and_blob_detector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "constrictor/image.hpp"
#include "perception/blobs.hpp"
#include "perception/line_tracer.hpp"
#include "perception/low_objects.hpp"
#include "perception/object_on_zone.hpp"
#include "perception/obstacles.hpp"
#include "perception/picture.hpp"
#include "perception/regions.hpp"

namespace constrictor::perception {
namespace {

msg::LinePercept line_percept(const LineTrace& trace, const LineFit& fit, std::uint8_t colour, double lookahead_m) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  msg::LinePercept line{};
  line.colour = colour;
  line.end_distance_m = kNan;
  line.lookahead_m = lookahead_m;
  line.offset_m = line.heading_rad = line.curvature_1_m = line.near_m = line.far_m = kNan;
  if (!fit.valid) return line;
  line.visible = true;
  line.lookahead_m = fit.lookahead_m;
  line.offset_m = fit.offset_m;
  line.heading_rad = fit.heading_rad;
  line.curvature_1_m = fit.curvature_1_m;
  line.end_visible = trace.end_visible;
  if (trace.end_visible) line.end_distance_m = trace.end.x();

  line.near_m = line.far_m = trace.points.front().p.x();
  for (const auto& point : trace.points) {
    line.near_m = std::min(line.near_m, point.p.x());
    line.far_m = std::max(line.far_m, point.p.x());
  }
  const std::size_t count =
      std::min<std::size_t>(trace.points.size(), static_cast<std::size_t>(msg::kMaxPerceptPoints));
  line.point_count = static_cast<std::uint16_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = count > 1 ? i * (trace.points.size() - 1) / (count - 1) : 0;
    line.x_m[i] = trace.points[at].p.x();
    line.y_m[i] = trace.points[at].p.y();
  }
  return line;
}

}  // namespace

std::string image_error(const msg::CameraImage& image, const msg::CameraInfo& info) {
  if (image.width != info.width || image.height != info.height) {
    return cv::format("size: found %d x %d, accepted %d x %d, the size in camera/info", image.width, image.height,
                      info.width, info.height);
  }
  if (image.width < 32 || image.height < 24)
    return cv::format("size: found %d x %d, accepted 32 x 24 or more", image.width, image.height);
  if (std::string violation = image_violation(image); !violation.empty()) return violation;
  // From a fish-eye of 170 degrees to a telescope of 1 degree.
  constexpr double kShortest = 0.04, kLongest = 60.0;
  const double size = std::max(info.width, info.height);
  const auto bounded = [](double value, double least, double most) { return value >= least && value <= most; };
  if (!bounded(info.fx, kShortest * size, kLongest * size) || !bounded(info.fy, kShortest * size, kLongest * size)) {
    return cv::format("not used: camera/info has the focal lengths %g and %g, accepted %g to %g pixels", info.fx,
                      info.fy, kShortest * size, kLongest * size);
  }
  if (!bounded(info.cx, -size, 2.0 * size) || !bounded(info.cy, -size, 2.0 * size)) {
    return cv::format("not used: camera/info has its centre at (%g, %g), accepted %g to %g pixels", info.cx, info.cy,
                      -size, 2.0 * size);
  }
  constexpr double kFarthest_m = 10.0;  // from the centre of its module
  const auto& p = info.X_HC.position_m;
  const auto& q = info.X_HC.orientation;
  const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (!bounded(p.x, -kFarthest_m, kFarthest_m) || !bounded(p.y, -kFarthest_m, kFarthest_m) ||
      !bounded(p.z, -kFarthest_m, kFarthest_m) || !bounded(square, 0.5, 2.0))
    return "not used: X_HC of camera/info, accepted a unit quaternion and a position within 10 m";
  return {};
}

LineAndBlobDetector::LineAndBlobDetector(const PerceptionConfig& config) : config_(config), classifier_(config) {
  cv::setNumThreads(1);
}

Percepts LineAndBlobDetector::detect(const cv::Mat& rgb, const GroundCamera& camera, std::uint8_t line_colour,
                                     const ObjectSizes& seen_sizes, const GroundColour& seen_ground) {
  const ObjectSizes sizes = config_.object_radius_m > 0.0
                                ? seen_sizes.with_prior(config_.object_radius_m, config_.object_height_m)
                                : seen_sizes;
  smoother_.smooth(rgb, smooth_);
  classifier_.classify(smooth_, labels_);
  const bool dazzled = recover_pale_colours(smooth_, classifier_, camera, glare_buffers_, labels_);
  Percepts percepts;
  percepts.ground = seen_ground;
  percepts.ground.learn(ground_in_view(smooth_, labels_, camera, tint_samples_));
  if (percepts.ground.coloured()) remove_ground(smooth_, percepts.ground, camera, labels_);
  find_regions(labels_, camera, config_, line_colour, percepts.ground, region_buffers_, regions_);
  regions_.dazzled = dazzled ? labels_.image : cv::Mat();
  mark_low_objects(smooth_, camera, config_, regions_);
  split_objects_from_zones(smooth_, camera, config_, sizes, regions_);
  const LineTrace trace = trace_line(labels_, regions_, camera, config_, line_colour);
  const Blobs blobs = find_blobs(smooth_, regions_, camera, config_, line_colour, sizes, percepts.measured);
  percepts.line = line_percept(trace, line_fitter_.fit(trace, config_.lookahead_m), line_colour, config_.lookahead_m);
  percepts.objects.blob_count = static_cast<std::uint16_t>(blobs.size());
  std::copy(blobs.begin(), blobs.end(), percepts.objects.blobs);
  for (const Eigen::Vector2d& p : find_obstacles(smooth_, regions_, camera, config_)) {
    percepts.objects.obstacle_x_m[percepts.objects.obstacle_count] = p.x();
    percepts.objects.obstacle_y_m[percepts.objects.obstacle_count++] = p.y();
  }
  return percepts;
}

const cv::Mat& LineAndBlobDetector::draw(const cv::Mat& rgb, const GroundCamera& camera, const msg::LinePercept& line,
                                         const msg::ObjectPercepts& objects) {
  draw_percepts(rgb, labels_.image, camera, line, objects, picture_);
  return picture_;
}

}  // namespace constrictor::perception
