// The sizes of objects in earlier images, by colour. Where the ground under an object has its colour, its foot cannot
// be seen: the known size then gives the range.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "constrictor/messages.hpp"

namespace constrictor::perception {

/// Size of an upright object.
struct ObjectSize {
  double radius_m = std::numeric_limits<double>::quiet_NaN();
  double height_m = std::numeric_limits<double>::quiet_NaN();
  std::int32_t images = 0;  ///< number of images in the average; counting stops at kMemoryImages
  [[nodiscard]] bool known() const { return images >= kEnoughImages; }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(radius_m, height_m, images);
  }
  static constexpr std::int32_t kEnoughImages = 3;
  static constexpr std::int32_t kMemoryImages = 30;
};

/// The sizes by colour. Of two objects of one colour, the one that was measured last counts most.
struct ObjectSizes {
  std::array<ObjectSize, msg::kColourCount> of{};

  /// Averages what one image has shown; an entry without images changes nothing.
  void learn(const ObjectSizes& measured) {
    for (std::size_t colour = 0; colour < of.size(); ++colour) {
      const ObjectSize& now = measured.of[colour];
      ObjectSize& size = of[colour];
      if (now.images == 0) continue;
      if (size.images == 0) size.radius_m = size.height_m = 0.0;
      size.images = std::min(size.images + 1, ObjectSize::kMemoryImages);
      size.radius_m += (now.radius_m - size.radius_m) / size.images;
      size.height_m += (now.height_m - size.height_m) / size.images;
    }
  }
  /// The same, with `radius_m` and `height_m` for the colours of which too few images have shown an object.
  [[nodiscard]] ObjectSizes with_prior(double radius_m, double height_m) const {
    ObjectSizes sizes = *this;
    for (ObjectSize& size : sizes.of) {
      if (!size.known()) size = {radius_m, height_m, ObjectSize::kEnoughImages};
    }
    return sizes;
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(of);
  }
};

}  // namespace constrictor::perception
