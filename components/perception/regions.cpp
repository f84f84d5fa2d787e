#include "perception/regions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace constrictor::perception {
namespace {

constexpr int kSpeckPixels = 4;  // smaller fragments are dropped before fragments are joined
constexpr double kHorizonMarginPixels = 1.0;

using Fragment = RegionBuffers::Fragment;

/// Whether two fragments of one colour are so close together that noise or a thin object in front has split one region.
bool adjoin(const Region& a, const Region& b) {
  const int larger = std::max({a.u_max - a.u_min, a.v_max - a.v_min, b.u_max - b.u_min, b.v_max - b.v_min});
  const int reach = 2 + std::min(4, larger / 10);
  return a.u_min - reach <= b.u_max && b.u_min - reach <= a.u_max && a.v_min - reach <= b.v_max &&
         b.v_min - reach <= a.v_max;
}

void merge_into(Region& a, const Region& b) {
  a.area += b.area;
  a.u_min = std::min(a.u_min, b.u_min);
  a.v_min = std::min(a.v_min, b.v_min);
  a.u_max = std::max(a.u_max, b.u_max);
  a.v_max = std::max(a.v_max, b.v_max);
}

/// The part of the image that contains all pixels of a colour, and a border wide enough that holes are filled as in the
/// whole image.
/// It begins at even indices: OpenCV numbers components in the order of blocks of 2 x 2 pixels, so the numbers are the
/// same as in the whole image.
cv::Rect window_of(const ColourExtent& extent, const cv::Size& size) {
  constexpr int kBorder = 2;
  const int left = std::max(extent.u_min - kBorder, 0) & ~1, top = std::max(extent.v_min - kBorder, 0) & ~1;
  const int right = std::min(extent.u_max + 1 + kBorder, size.width);
  const int bottom = std::min(extent.v_max + 1 + kBorder, size.height);
  return {left, top, right - left, bottom - top};
}

/// Adds the regions of one colour to `out`.
void add_colour(const Labels& labels, std::uint8_t colour, int min_area, RegionBuffers& buffers, Regions& out) {
  static const cv::Mat kSquare = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
  const cv::Rect window = window_of(labels.extents[colour], labels.image.size());
  buffers.mask.create(labels.image.size(), CV_8UC1);
  buffers.components.create(labels.image.size(), CV_16UC1);
  cv::Mat mask = buffers.mask(window), components = buffers.components(window);
  cv::compare(labels.image(window), colour, mask, cv::CMP_EQ);
  // Fills the small holes that noise makes. The rest of the buffer has nothing to do with this image.
  cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, kSquare, {-1, -1}, 1, cv::BORDER_CONSTANT | cv::BORDER_ISOLATED);
  const int count = cv::connectedComponentsWithStats(mask, components, buffers.stats, buffers.centroids, 8, CV_16U);

  std::vector<Fragment>& fragments = buffers.fragments;
  fragments.clear();
  for (int i = 1; i < count; ++i) {
    const int* s = buffers.stats.ptr<int>(i);
    if (s[cv::CC_STAT_AREA] < kSpeckPixels) continue;
    Region region;
    region.colour = colour;
    region.area = s[cv::CC_STAT_AREA];
    region.u_min = window.x + s[cv::CC_STAT_LEFT];
    region.v_min = window.y + s[cv::CC_STAT_TOP];
    region.u_max = region.u_min + s[cv::CC_STAT_WIDTH] - 1;
    region.v_max = region.v_min + s[cv::CC_STAT_HEIGHT] - 1;
    fragments.push_back({region, i});
  }
  std::sort(fragments.begin(), fragments.end(), [](const Fragment& a, const Fragment& b) {
    return a.region.area != b.region.area ? a.region.area > b.region.area : a.component < b.component;
  });
  fragments.resize(std::min<std::size_t>(fragments.size(), 64));

  // Each fragment joins the first larger group that it adjoins.
  std::vector<int>& group = buffers.group;
  group.assign(fragments.size(), -1);
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    if (group[i] >= 0) continue;
    group[i] = static_cast<int>(i);
    for (bool grown = true; grown;) {
      grown = false;
      for (std::size_t j = i + 1; j < fragments.size(); ++j) {
        if (group[j] < 0 && adjoin(fragments[i].region, fragments[j].region)) {
          merge_into(fragments[i].region, fragments[j].region);
          group[j] = static_cast<int>(i);
          grown = true;
        }
      }
    }
  }

  auto& id_of_component = buffers.id_of_component;
  auto& id_of_group = buffers.id_of_group;
  id_of_component.assign(static_cast<std::size_t>(count), 0);
  id_of_group.assign(fragments.size(), 0);
  for (std::size_t i = 0; i < fragments.size(); ++i) {
    const auto g = static_cast<std::size_t>(group[i]);
    if (g == i && fragments[i].region.area >= min_area && out.regions.size() < kMaxRegions) {
      out.regions.push_back(fragments[i].region);
      id_of_group[i] = static_cast<std::uint8_t>(out.regions.size());
    }
    id_of_component[static_cast<std::size_t>(fragments[i].component)] = id_of_group[g];
  }
  for (int v = 0; v < window.height; ++v) {
    const std::uint16_t* in = components.ptr<std::uint16_t>(v);
    std::uint8_t* ids = out.ids.ptr<std::uint8_t>(window.y + v) + window.x;
    for (int u = 0; u < window.width; ++u) {
      if (in[u] != 0 && id_of_component[in[u]] != 0) ids[u] = id_of_component[in[u]];
    }
  }
}

/// Whether a region is only the blurred border between larger regions of other colours: it is thin and lies between
/// them.
bool is_fringe(const Regions& all, std::size_t index) {
  const Region& region = all.regions[index];
  const int length = std::max(region.u_max - region.u_min, region.v_max - region.v_min) + 1;
  if (region.area > 4 * length) return false;
  constexpr int kReach = 3;
  constexpr std::array<std::array<int, 2>, 4> kOffsets{{{kReach, 0}, {-kReach, 0}, {0, kReach}, {0, -kReach}}};
  int beside = 0;
  for (int v = region.v_min; v <= region.v_max; ++v) {
    for (int u = region.u_min; u <= region.u_max; ++u) {
      if (all.ids.at<std::uint8_t>(v, u) != index + 1) continue;
      for (const auto& offset : kOffsets) {
        const int u2 = u + offset[0], v2 = v + offset[1];
        if (u2 < 0 || v2 < 0 || u2 >= all.ids.cols || v2 >= all.ids.rows) continue;
        const int other = all.ids.at<std::uint8_t>(v2, u2);
        if (other == 0 || other == static_cast<int>(index) + 1) continue;
        const Region& neighbour = all.regions[static_cast<std::size_t>(other - 1)];
        if (neighbour.colour != region.colour && neighbour.area > 3 * region.area) {
          ++beside;
          break;
        }
      }
    }
  }
  return beside * 2 > region.area;
}

void find_standing_columns(const cv::Mat& ids, std::uint8_t id, const GroundCamera& camera, Region& region) {
  constexpr double kEdgePixels = 1.0;  // standard deviation of an edge
  region.standing_first = ids.cols;
  region.standing_last = -1;
  for (int u = region.u_min; u <= region.u_max; ++u) {
    const double limit = camera.horizon_row(u + 0.5) - kHorizonMarginPixels;
    for (int v = region.v_min; v <= region.v_max && v <= limit; ++v) {
      if (ids.at<std::uint8_t>(v, u) != id) continue;
      region.standing_first = std::min(region.standing_first, u);
      region.standing_last = u;
      region.rise_sd = std::max(region.rise_sd, (limit + kHorizonMarginPixels - v) / kEdgePixels);
      break;
    }
  }
  region.standing_bottom = region.v_min;
  for (int v = region.v_min; v <= region.v_max; ++v) {
    int count = 0;
    for (int u = region.standing_first; u <= region.standing_last; ++u)
      count += ids.at<std::uint8_t>(v, u) == id ? 1 : 0;
    if (5 * count >= 3 * (region.standing_last - region.standing_first + 1)) region.standing_bottom = v;
  }
}

/// Whether an upright region, on ground of its colour, ends at the horizon, because no foot was found below it.
bool foot_is_unseen(const Region& region, const GroundCamera& camera, const GroundColour& ground) {
  if (!region.standing() || !ground.coloured() || region.colour != ground.colour) return false;
  const double middle = 0.5 * (region.standing_first + region.standing_last + 1);
  return region.standing_bottom <= camera.horizon_row(middle) + kHorizonMarginPixels;
}

/// Whether a flat region is so long and thin on the ground that it is a piece of line.
bool is_elongated(const cv::Mat& ids, std::uint8_t id, const GroundCamera& camera, const Region& region,
                  double line_width_m, std::vector<Eigen::Vector2d>& points) {
  double area_m2 = 0.0, nearest_m = 1e9;
  points.clear();
  for (int v = region.v_min; v <= region.v_max; ++v) {
    int first = -1, last = -1, count = 0;
    for (int u = region.u_min; u <= region.u_max; ++u) {
      if (ids.at<std::uint8_t>(v, u) != id) continue;
      if (first < 0) first = u;
      last = u;
      ++count;
    }
    if (count == 0) continue;
    const auto left = camera.ground(first + 0.5, v + 0.5);
    const auto right = camera.ground(last + 0.5, v + 0.5);
    if (!left || !right) continue;
    const double range_m = (0.5 * (*left + *right) - camera.position_on_ground()).norm();
    nearest_m = std::min(nearest_m, range_m);
    area_m2 += count * camera.pixel_across_m(range_m) * camera.pixel_along_m(range_m);
    points.push_back(*left);
    points.push_back(*right);
  }
  if (points.empty()) return false;
  // The longest extent: from any point to the farthest point, and from there to the farthest point again.
  const auto farthest_from = [&](const Eigen::Vector2d& p) {
    return *std::max_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
      return (a - p).squaredNorm() < (b - p).squaredNorm();
    });
  };
  const Eigen::Vector2d end = farthest_from(points.front());
  // One or two rows of distant ground have no shape.
  if (region.area <= 3 * std::max(region.u_max - region.u_min + 1, region.v_max - region.v_min + 1) &&
      nearest_m > 0.7) {
    return true;
  }
  const double length_m = std::max((farthest_from(end) - end).norm(), 1e-3);
  const double thickness_m = area_m2 / length_m;
  const double aspect = 0.785 * length_m * length_m / std::max(area_m2, 1e-6);  // 1 for a disc
  return thickness_m < 2.0 * line_width_m + 2.5 * camera.pixel_across_m(nearest_m) || aspect > 2.5;
}

}  // namespace

void find_regions(const Labels& labels, const GroundCamera& camera, const PerceptionConfig& config,
                  std::uint8_t line_colour, const GroundColour& ground, RegionBuffers& buffers, Regions& out) {
  out.regions.clear();
  out.ground = ground;
  out.ids.create(labels.image.size(), CV_8UC1);
  out.ids.setTo(0);
  for (std::uint8_t colour = 1; colour < msg::kColourCount; ++colour) {
    if (labels.extents[colour].pixels >= config.min_area_pixels)
      add_colour(labels, colour, config.min_area_pixels, buffers, out);
  }

  for (std::size_t i = 0; i < out.regions.size(); ++i) {
    Region& region = out.regions[i];
    const auto id = static_cast<std::uint8_t>(i + 1);
    if (is_fringe(out, i)) {
      region.area = 0;
      continue;
    }
    find_standing_columns(out.ids, id, camera, region);
    region.on_zone = foot_is_unseen(region, camera, ground);
    region.line = region.colour == line_colour && !region.standing() &&
                  is_elongated(out.ids, id, camera, region, config.line_width_m, buffers.points);
  }
}

}  // namespace constrictor::perception
