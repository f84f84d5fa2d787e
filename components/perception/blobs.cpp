#include "perception/blobs.hpp"

#include <algorithm>
#include <array>

#include "perception/gauge.hpp"

namespace constrictor::perception {
namespace {

/// Adds a blob behind all that are at least as large. If there are too many, the last one is dropped.
void add(Blobs& blobs, const msg::Blob& blob) {
  const auto larger = [](const msg::Blob& a, const msg::Blob& b) { return a.area_fraction > b.area_fraction; };
  if (blobs.full()) {
    if (!larger(blob, blobs.back())) return;
    blobs.pop_back();
  }
  blobs.push_back(blob);
  std::rotate(std::upper_bound(blobs.begin(), blobs.end() - 1, blob, larger), blobs.end() - 1, blobs.end());
}

}  // namespace

Blobs find_blobs(const cv::Mat& rgb, const Regions& regions, const GroundCamera& camera, const PerceptionConfig& config,
                 std::uint8_t line_colour, const ObjectSizes& sizes, MeasuredSizes& measured) {
  Blobs blobs;
  std::array<int, msg::kColourCount> measured_area{};
  for (std::size_t i = 0; i < regions.regions.size(); ++i) {
    const Region& region = regions.regions[i];
    if (region.area < config.min_area_pixels || region.line) continue;
    const Gauge gauge(rgb, regions, i, camera, config, sizes);
    ObjectSize size;
    if (region.standing()) {
      bool with_zone = false, nearer = false;
      if (!region.low && region.colour != line_colour) {
        int flat_pixels = 0;
        gauge.flat_part(flat_pixels, nearer);
        // Beside the sides of a high object there are stray pixels of its colour.
        const int stray = std::min(region.area / 8, 2 * (region.v_max - region.v_min + 1));
        with_zone = flat_pixels > std::max(2 * config.min_area_pixels, stray);
      }
      const bool on_zone = region.on_zone || (with_zone && nearer);
      if (const auto blob = gauge.object(on_zone, size)) add(blobs, *blob);
      // Of several objects of one colour the nearest one is measured best, and it is the largest in most images.
      if (size.images > 0 && region.area > measured_area[region.colour]) {
        measured_area[region.colour] = region.area;
        measured[region.colour] = size;
      }
      if (with_zone) {
        if (const auto blob = gauge.zone()) add(blobs, *blob);
      }
    } else if (const auto blob = gauge.zone()) {
      add(blobs, *blob);
    }
  }
  return blobs;
}

}  // namespace constrictor::perception
