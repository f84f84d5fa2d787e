// The sizes of objects in earlier images, by colour. Where the ground under an object has its colour, its foot cannot
// be seen: the known size then gives the range.
#pragma once

#include <algorithm>
#include <array>
#include <cereal/types/array.hpp>
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
  /// Whether both may be of one object: radius and height differ by less than a quarter.
  [[nodiscard]] bool like(const ObjectSize& other) const {
    constexpr double kAlike = 0.25;
    return std::abs(std::log(radius_m / other.radius_m)) < kAlike &&
           std::abs(std::log(height_m / other.height_m)) < kAlike;
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(radius_m, height_m, images);
  }
  static constexpr std::int32_t kEnoughImages = 3;
  static constexpr std::int32_t kMemoryImages = 30;
};

/// What one image has shown: of each colour, the size of at most one object.
using MeasuredSizes = std::array<ObjectSize, msg::kColourCount>;

/// The sizes of the objects of one colour, the one that was measured last first. A further size takes the place of one
/// that few images have shown, otherwise of the one that was measured longest ago.
struct SizesOfColour {
  std::array<ObjectSize, 3> sizes{};

  void learn(const ObjectSize& now) {
    if (now.images == 0) return;
    auto found = std::find_if(sizes.begin(), sizes.end(), [&](const ObjectSize& size) { return size.like(now); });
    if (found == sizes.end()) {
      const auto few = std::find_if(sizes.rbegin(), sizes.rend(), [](const ObjectSize& size) { return !size.known(); });
      found = few == sizes.rend() ? sizes.end() - 1 : few.base() - 1;
      *found = {0.0, 0.0, 0};
    }
    std::rotate(sizes.begin(), found, found + 1);
    ObjectSize& size = sizes.front();
    size.images = std::min(size.images + 1, ObjectSize::kMemoryImages);
    size.radius_m += (now.radius_m - size.radius_m) / size.images;
    size.height_m += (now.height_m - size.height_m) / size.images;
  }
  [[nodiscard]] std::size_t known_count() const {
    return static_cast<std::size_t>(
        std::count_if(sizes.begin(), sizes.end(), [](const ObjectSize& size) { return size.known(); }));
  }
  [[nodiscard]] bool known() const { return known_count() > 0; }
  /// The known size that was measured last; not known if none is.
  [[nodiscard]] ObjectSize first_known() const {
    const auto found = std::find_if(sizes.begin(), sizes.end(), [](const ObjectSize& size) { return size.known(); });
    return found == sizes.end() ? ObjectSize{} : *found;
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(sizes);
  }
};

/// The sizes by colour.
struct ObjectSizes {
  std::array<SizesOfColour, msg::kColourCount> of{};

  /// Averages what one image has shown; an entry without images changes nothing.
  void learn(const MeasuredSizes& measured) {
    for (std::size_t colour = 0; colour < of.size(); ++colour) of[colour].learn(measured[colour]);
  }
  /// The same, with `radius_m` and `height_m` for the colours of which too few images have shown an object.
  [[nodiscard]] ObjectSizes with_prior(double radius_m, double height_m) const {
    ObjectSizes sizes = *this;
    for (SizesOfColour& colour : sizes.of) {
      if (!colour.known()) colour.sizes.front() = {radius_m, height_m, ObjectSize::kEnoughImages};
    }
    return sizes;
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(of);
  }
};

}  // namespace constrictor::perception
