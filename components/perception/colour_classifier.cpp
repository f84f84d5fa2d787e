#include "perception/colour_classifier.hpp"

#include <algorithm>

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

}  // namespace

ColourClassifier::ColourClassifier(const PerceptionConfig& config) : table_(64 * 64 * 64, msg::kColourUnknown) {
  for (int ri = 0; ri < 64; ++ri) {
    for (int gi = 0; gi < 64; ++gi) {
      for (int bi = 0; bi < 64; ++bi) {
        // The colour at the centre of the cell.
        const double r = (ri * 4 + 1.5) / 255.0, g = (gi * 4 + 1.5) / 255.0, b = (bi * 4 + 1.5) / 255.0;
        const double largest = std::max({r, g, b});
        const double chroma = largest - std::min({r, g, b});
        if (chroma < config.min_chroma || chroma < config.min_saturation * largest) continue;
        const double hue = hue_deg(r, g, b, largest, chroma);
        for (std::size_t colour = 1; colour < config.hues.size(); ++colour) {
          if (within(hue, config.hues[colour])) {
            table_[static_cast<std::size_t>(ri << 12 | gi << 6 | bi)] = static_cast<std::uint8_t>(colour);
            break;
          }
        }
      }
    }
  }
}

void ColourClassifier::classify(const cv::Mat& rgb, cv::Mat& labels) const {
  labels.create(rgb.rows, rgb.cols, CV_8UC1);
  for (int v = 0; v < rgb.rows; ++v) {
    const std::uint8_t* in = rgb.ptr<std::uint8_t>(v);
    std::uint8_t* out = labels.ptr<std::uint8_t>(v);
    for (int u = 0; u < rgb.cols; ++u, in += 3) out[u] = table_[index(in[0], in[1], in[2])];
  }
}

}  // namespace constrictor::perception
