#include "bench/peg_fields/peg_picture.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "sim/figure/canvas.hpp"

namespace constrictor::peg_fields {
namespace {

using figure::Canvas;
using figure::Colour;
using figure::Point;
using figure::Rect;

constexpr double kPixels_m = 110.0;  // units of the drawing for a metre
constexpr double kMargin = 14.0;
constexpr double kHeading = 28.0;
constexpr double kFrom_m = -2.5, kTo_m = 5.5;  // shown along x
constexpr double kHalfWidth_m = 1.6;           // shown along y

constexpr double kWidth = (kTo_m - kFrom_m) * kPixels_m + 2.0 * kMargin;
constexpr double kPanel = kHeading + 2.0 * kHalfWidth_m * kPixels_m + kMargin;

void draw_disc(Canvas& canvas, const Rect& clip, const Point& centre, double radius, const Colour& colour) {
  std::vector<Point> ring;
  for (int i = 0; i <= 16; ++i) {
    const double angle = i * std::numbers::pi / 8.0;
    ring.push_back({centre.x + 0.5 * radius * std::cos(angle), centre.y + 0.5 * radius * std::sin(angle)});
  }
  canvas.polyline(ring, clip, colour, radius);
}

Colour shade(double share) {
  const Colour pale{0.74, 0.82, 0.90}, dark{0.06, 0.25, 0.47};
  const auto mix = [share](double from, double to) { return from + share * (to - from); };
  return {mix(pale.red, dark.red), mix(pale.green, dark.green), mix(pale.blue, dark.blue)};
}

void draw_panel(Canvas& canvas, double top, const Panel& panel, double body_radius_m) {
  canvas.text(panel.title, {kMargin, top + 18.0}, {14.0, figure::kInk, true});
  const Rect area{kMargin, top + kHeading, kWidth - 2.0 * kMargin, 2.0 * kHalfWidth_m * kPixels_m};
  canvas.frame(area, figure::kFrame, 1.0);
  const auto place = [&](const Eigen::Vector2d& at) {
    return Point{area.x + (at.x() - kFrom_m) * kPixels_m, area.y + (kHalfWidth_m - at.y()) * kPixels_m};
  };
  for (const ScenarioObstacle& peg : panel.scene.obstacles)
    draw_disc(canvas, area, place(peg.position_m), peg.size_m.x() * kPixels_m, figure::kGreyInk);
  const auto& outlines = panel.course.outlines;
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const Colour colour =
        shade(outlines.size() > 1 ? static_cast<double>(i) / static_cast<double>(outlines.size() - 1) : 1.0);
    std::vector<Point> body;
    for (const Eigen::Vector2d& at : outlines[i]) body.push_back(place(at));
    canvas.polyline(body, area, colour, 2.0 * body_radius_m * kPixels_m);
    const Point& head = body.front();
    if (head.y < area.y || head.y > area.y + area.height) continue;
    canvas.fill({head.x - 4.0, head.y - 4.0, 8.0, 8.0}, figure::kRedInk);
  }
}

}  // namespace

void draw(const std::filesystem::path& file, const std::vector<Panel>& panels, double body_radius_m) {
  const double height = kMargin + kPanel * static_cast<double>(panels.size());
  Canvas canvas(figure::Format::kPng, kWidth, height, 1.0, "Fields of pegs");
  canvas.fill({0.0, 0.0, kWidth, height}, figure::kWhite);
  double top = 0.5 * kMargin;
  for (const Panel& panel : panels) {
    draw_panel(canvas, top, panel, body_radius_m);
    top += kPanel;
  }
  std::ofstream(file, std::ios::binary) << canvas.finish();
}

}  // namespace constrictor::peg_fields
