// Measures a region of the image as an object, as a zone, or as both.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>

#include "constrictor/messages.hpp"
#include "perception/ground_camera.hpp"
#include "perception/object_sizes.hpp"
#include "perception/perception_config.hpp"
#include "perception/regions.hpp"
#include "perception/sight.hpp"

namespace constrictor::perception {

/// Measures one region. Azimuths and ranges are relative to the camera; `finish` converts them to the head.
class Gauge {
 public:
  Gauge(const cv::Mat& rgb, const Regions& regions, std::size_t index, const GroundCamera& camera,
        const PerceptionConfig& config, const ObjectSizes& sizes);

  /// The part that stands upright. `on_zone`: a zone of the same colour adjoins its lower edge. `measured` becomes the
  /// object's size if the image shows it.
  [[nodiscard]] std::optional<msg::Blob> object(bool on_zone, ObjectSize& measured) const;

  /// The part that lies flat: the whole region, or the part beside the object. If the object stands before it and hides
  /// its near edge, only its direction is known.
  [[nodiscard]] std::optional<msg::Blob> zone() const;

  /// The pixels beside the object, and whether the flat part reaches nearer than the object.
  void flat_part(int& pixels, bool& nearer) const;

 private:
  /// Whether the lower edge of the object goes on beside it without a step, so that it is the rim of the flat part.
  /// `flat_part` asks where the border of the image cuts the object: there, the rim in view may be lower than beside
  /// it.
  [[nodiscard]] bool edge_goes_on() const;

  /// Whether a pixel lies between the vertical planes of the object's sides, or two pixels beyond.
  [[nodiscard]] bool in_object(int u, int v) const;

  /// Whether the robot's body hides what lies beyond the side of the region, in the image of a further camera.
  [[nodiscard]] bool hidden_beyond(int u, int v) const;

  /// Whether a flat region at the image's border could be the foot of an object whose upper part is out of view: with
  /// the camera tilted, upright edges lean outwards in the image.
  [[nodiscard]] bool may_be_object(const msg::Blob& blob, double left, double right) const;

  [[nodiscard]] double azimuth(const Eigen::Vector2d& pixel) const { return azimuth_rad(camera_, pixel); }

  [[nodiscard]] msg::Blob box(int u_min, int u_max) const;

  /// Azimuths of an object's sides at the horizon, where nothing flat can hide them.
  void find_sides();

  [[nodiscard]] double lower_edge_range(double left, double right, bool& cut) const;

  /// Whether the lower edge of the flat part, whose sides have these azimuths, is clearly farther away right beside the
  /// object than below it: below the object is the object's foot, then, and no edge of the flat part.
  [[nodiscard]] bool is_behind_object(double left, double right) const;

  /// `range_m`: the range that follows from the lower edge of the object. Returns whether this edge belongs in truth to
  /// a zone of the same colour in front of the object, which is too thin in the image to be seen as a zone. The sign of
  /// it is that at this range the object would be narrower than every known object. Always false up to 1.5 m.
  [[nodiscard]] bool ends_in_zone(double range_m) const;

  /// [m] horizontal distance of an object of this size by its width; NaN if the size is not known.
  [[nodiscard]] double range_by_width(const ObjectSize& size) const;
  /// [m] horizontal distance of an object of this height by its upper edge; NaN if it is not high enough above the
  /// camera. `slope`: of the line of sight to the upper edge.
  [[nodiscard]] double range_by_height(double height_m, double slope) const;
  /// Of the known sizes of this colour, the one whose height fits the upper edge at the distance that its width gives,
  /// and with which the object stands on the flat part if it is `on_zone`. If several fit, or too little is in view to
  /// compare them, the one that was measured last. Not known if none is.
  [[nodiscard]] ObjectSize likeliest_size(const msg::Blob& blob, double slope, bool on_zone) const;
  /// [m] least and greatest distance of an object that stands on the flat part; 0 and infinity if they are not in view.
  [[nodiscard]] std::pair<double, double> ground_around() const;
  /// Slope of the line of sight to the upper edge; NaN if no edge is in view.
  [[nodiscard]] double upper_slope() const;
  /// [m] horizontal distance of an object of known size: by its width, otherwise by its upper edge; NaN if too little
  /// of it is in view, or if it is not high enough above the camera.
  [[nodiscard]] double range_by_size(const msg::Blob& blob, bool on_zone) const;

  /// [m] height above the ground of the object at this range; NaN if unknown. `cut_top`: the height up to the border of
  /// the image.
  [[nodiscard]] double height_m(double range_m, bool cut_top) const;

  /// Bearing, range and width of a round object between two tangents, converted from the camera to the head.
  [[nodiscard]] std::optional<msg::Blob> finish(msg::Blob blob, double left, double right, double range_m) const;

  const cv::Mat& rgb_;
  const Regions& regions_;
  const Region& region_;
  std::uint8_t id_;
  const GroundCamera& camera_;
  const PerceptionConfig& config_;
  const SizesOfColour& sizes_;
  double left_ = 0.0, right_ = 0.0;  ///< azimuths of an object's sides
  bool left_open_ = false, right_open_ = false;
  bool left_hidden_ = false, right_hidden_ = false;  ///< something, or the robot's body, hides this side
};

}  // namespace constrictor::perception
