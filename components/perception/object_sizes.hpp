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
#include "perception/few.hpp"

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

/// The sizes of the objects of one colour: the mean over all images, and the sizes that differ from each other.
struct SizesOfColour {
  ObjectSize mean;
  /// The size that was measured last comes first. A further one takes the place of the one that fewest images have
  /// shown.
  std::array<ObjectSize, 3> different{};

  void learn(const ObjectSize& now) {
    if (now.images == 0) return;
    average(mean, now);
    auto found =
        std::find_if(different.begin(), different.end(), [&](const ObjectSize& size) { return size.like(now); });
    if (found == different.end()) {
      const auto fewer = [](const ObjectSize& a, const ObjectSize& b) { return a.images < b.images; };
      found = std::min_element(different.rbegin(), different.rend(), fewer).base() - 1;
      *found = {};
    }
    std::rotate(different.begin(), found, found + 1);
    average(different.front(), now);
  }
  [[nodiscard]] bool known() const { return mean.known(); }
  /// The sizes that an object may have, the one that was measured last first: the mean, or else the different sizes, if
  /// there are several. A third as many images must have shown each of them as the one that most have shown: what a few
  /// images show of an object that the body hides in part is not another object. Empty if none is known.
  [[nodiscard]] Few<ObjectSize, 3> candidates() const {
    std::int32_t most = 0;
    for (const ObjectSize& size : different) most = std::max(most, size.images);
    Few<ObjectSize, 3> sizes;
    for (const ObjectSize& size : different)
      if (size.known() && 3 * size.images >= most) sizes.push_back(size);
    if (sizes.size() > 1) return sizes;
    Few<ObjectSize, 3> usual;
    if (known()) usual.push_back(mean);
    return usual;
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(mean, different);
  }

 private:
  static void average(ObjectSize& size, const ObjectSize& now) {
    if (size.images == 0) size.radius_m = size.height_m = 0.0;
    size.images = std::min(size.images + 1, ObjectSize::kMemoryImages);
    size.radius_m += (now.radius_m - size.radius_m) / size.images;
    size.height_m += (now.height_m - size.height_m) / size.images;
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
      if (!colour.known()) colour.mean = {radius_m, height_m, ObjectSize::kEnoughImages};
    }
    return sizes;
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(of);
  }
};

}  // namespace constrictor::perception
