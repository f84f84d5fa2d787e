#include "perception/blobs.hpp"

#include <algorithm>
#include <array>

#include "perception/gauge.hpp"

namespace constrictor::perception {

std::vector<msg::Blob> find_blobs(const cv::Mat& rgb, const Regions& regions, const GroundCamera& camera,
                                  const PerceptionConfig& config, std::uint8_t line_colour, const ObjectSizes& sizes,
                                  MeasuredSizes& measured) {
  std::vector<msg::Blob> blobs;
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
      if (const auto blob = gauge.object(on_zone, size)) blobs.push_back(*blob);
      // Of several objects of one colour the nearest one is measured best, and it is the largest in most images.
      if (size.images > 0 && region.area > measured_area[region.colour]) {
        measured_area[region.colour] = region.area;
        measured[region.colour] = size;
      }
      if (with_zone) {
        if (const auto blob = gauge.zone()) blobs.push_back(*blob);
      }
    } else if (const auto blob = gauge.zone()) {
      blobs.push_back(*blob);
    }
  }
  std::stable_sort(blobs.begin(), blobs.end(),
                   [](const msg::Blob& a, const msg::Blob& b) { return a.area_fraction > b.area_fraction; });
  if (blobs.size() > static_cast<std::size_t>(msg::kMaxBlobs)) blobs.resize(static_cast<std::size_t>(msg::kMaxBlobs));
  return blobs;
}

}  // namespace constrictor::perception
