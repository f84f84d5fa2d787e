#include "perception/colour_classifier.hpp"

#include <algorithm>
#include <opencv2/core/hal/intrin.hpp>

namespace constrictor::perception {
namespace {

/// Hue [degrees] as in the HSV hexagon; `chroma` > 0.
double hue_deg(double r, double g, double b, double largest, double chroma) {
  double sextant;
  if (largest == r) {
    sextant = (g - b) / chroma;
  } else if (largest == g) {
    sextant = 2.0 + (b - r) / chroma;
  } else {
    sextant = 4.0 + (r - g) / chroma;
  }
  return sextant < 0.0 ? 60.0 * sextant + 360.0 : 60.0 * sextant;
}

bool within(double hue, const HueRange& range) {
  if (range.from_deg <= range.to_deg) return hue >= range.from_deg && hue <= range.to_deg;
  return hue >= range.from_deg || hue <= range.to_deg;
}

/// The first colour whose hues contain this one; kColourUnknown: there is none.
std::uint8_t colour_with(double hue, const std::array<HueRange, msg::kColourCount>& hues) {
  for (std::uint8_t colour = 1; colour < msg::kColourCount; ++colour) {
    if (within(hue, hues[colour])) return colour;
  }
  return msg::kColourUnknown;
}

}  // namespace

ColourClassifier::ColourClassifier(const PerceptionConfig& config)
    : hues_(config.hues), table_(64 * 64 * 64, msg::kColourUnknown) {
  int least_spread = 64;  // between the indices of a coloured cell
  for (int ri = 0; ri < 64; ++ri) {
    for (int gi = 0; gi < 64; ++gi) {
      for (int bi = 0; bi < 64; ++bi) {
        // The colour at the centre of the cell.
        const double r = (ri * 4 + 1.5) / 255.0, g = (gi * 4 + 1.5) / 255.0, b = (bi * 4 + 1.5) / 255.0;
        const double largest = std::max({r, g, b});
        const double chroma = largest - std::min({r, g, b});
        if (chroma < config.min_chroma || chroma < config.min_saturation * largest) continue;
        const std::uint8_t colour = colour_with(hue_deg(r, g, b, largest, chroma), hues_);
        if (colour == msg::kColourUnknown) continue;
        table_[static_cast<std::size_t>(ri << 12 | gi << 6 | bi)] = colour;
        least_spread = std::min(least_spread, std::max({ri, gi, bi}) - std::min({ri, gi, bi}));
      }
    }
  }
  // The indices of two channels that differ by d are at most (d + 3) / 4 apart.
  grey_spread_ = static_cast<std::uint8_t>(4 * std::max(least_spread - 1, 0));
}

std::uint8_t ColourClassifier::colour_of_hue(std::uint8_t r, std::uint8_t g, std::uint8_t b) const {
  const int largest = std::max({r, g, b}), chroma = largest - std::min({r, g, b});
  return chroma > 0 ? colour_with(hue_deg(r, g, b, largest, chroma), hues_) : std::uint8_t{msg::kColourUnknown};
}

bool ColourClassifier::block_is_grey(const std::uint8_t* rgb) const {
  // Compares three successive bytes at every byte and not only where a pixel begins, because that needs no shuffle
  // instructions. Triples with bytes of two pixels can only make a grey block count as coloured, which costs time and
  // changes no label. The last 16 triples overlap the 16 before, because no triple may reach beyond the block.
  static_assert(kBlock == 16, "the places below cover 16 pixels");
  cv::v_uint8x16 spread = cv::v_setzero_u8();
  for (const int first : {0, 16, 3 * kBlock - 18}) {
    const cv::v_uint8x16 a = cv::v_load(rgb + first), b = cv::v_load(rgb + first + 1), c = cv::v_load(rgb + first + 2);
    spread = cv::v_max(spread, cv::v_max(cv::v_max(a, b), c) - cv::v_min(cv::v_min(a, b), c));
  }
  return !cv::v_check_any(spread > cv::v_setall_u8(grey_spread_));
}

void ColourClassifier::classify(const cv::Mat& rgb, Labels& labels) const {
  labels.image.create(rgb.rows, rgb.cols, CV_8UC1);
  labels.extents = {};
  for (int v = 0; v < rgb.rows; ++v) {
    const std::uint8_t* in = rgb.ptr<std::uint8_t>(v);
    std::uint8_t* out = labels.image.ptr<std::uint8_t>(v);
    for (int u = 0; u < rgb.cols;) {
      if (u + kBlock <= rgb.cols && block_is_grey(in + 3 * u)) {
        std::fill_n(out + u, kBlock, msg::kColourUnknown);
        u += kBlock;
        continue;
      }
      for (const int end = std::min(u + kBlock, rgb.cols); u < end; ++u) {
        out[u] = colour_of(in[3 * u], in[3 * u + 1], in[3 * u + 2]);
        if (out[u] != msg::kColourUnknown) labels.extents[out[u]].add(u, v);
      }
    }
  }
}

}  // namespace constrictor::perception
