#include "sim/figure/film_frame.hpp"

#include <algorithm>

namespace constrictor::figure {
namespace {

constexpr double kTorqueWindow_s = 20.0;
constexpr TextStyle kPanelTitle{15.0, kInk, true};
constexpr Rect kCamera{864.0, 78.0, 400.0, 276.0};
constexpr Rect kProcessed{864.0, 388.0, 400.0, 276.0};
constexpr Rect kTorques{16.0, 500.0, 832.0, 172.0};
constexpr Rect kBar{16.0, 688.0, 1248.0, 12.0};

}  // namespace

double film_scale(int width_px, int height_px) { return std::min(width_px / kFilmWidth, height_px / kFilmHeight); }

void draw_film_frame(Canvas& canvas, int width_px, int height_px, const FilmFrame& frame, const TorqueSeries& torques,
                     double limit_nm, const std::vector<FilmMark>& marks) {
  const double scale = film_scale(width_px, height_px);
  // A frame of another shape has white borders.
  const double dx = 0.5 * (width_px / scale - kFilmWidth), dy = 0.5 * (height_px / scale - kFilmHeight);
  const auto moved = [&](const Rect& area) { return Rect{area.x + dx, area.y + dy, area.width, area.height}; };
  const auto at = [&](double x, double y) { return Point{x + dx, y + dy}; };
  canvas.fill({0.0, 0.0, width_px / scale, height_px / scale}, kWhite);

  const std::string time = number(frame.time_s, 1) + " s";
  canvas.text(time, at(16.0, 36.0), {26.0, kInk, true});
  const TextStyle state{20.0, kInk};
  canvas.text(canvas.fitted(frame.state, 400.0, state), at(150.0, 36.0), state);
  const TextStyle event{17.0, kGreyInk};
  canvas.text(canvas.fitted(frame.event, 380.0, event), at(560.0, 36.0), event);
  const TextStyle title{14.0, kGreyInk, false, Align::kRight};
  canvas.text(canvas.fitted(frame.title, 310.0, title), at(1264.0, 36.0), title);

  const auto panel = [&](const char* name, const Rect& area, const Picture& picture, const std::string& missing) {
    canvas.text(name, at(area.x, area.y - 8.0), kPanelTitle);
    draw_picture(canvas, moved(area), picture, missing);
  };
  panel("Scene", kFilmScene, frame.scene, "no picture: the recording has no simulated world");
  panel("Camera", kCamera, frame.camera, "no image");
  panel("Processed", kProcessed, frame.processed, "no image");

  static constexpr const char* kTorqueTitle = "Yaw torques [Nm]";
  canvas.text(kTorqueTitle, at(kTorques.x, kTorques.y), kPanelTitle);
  draw_joint_key(canvas, torques.torque_nm.size(), dx + kTorques.x + canvas.width_of(kTorqueTitle, kPanelTitle) + 10.0,
                 dx + kTorques.x + kTorques.width, dy + kTorques.y, 13.0);
  TorqueAxes axes;
  axes.limit_nm = limit_nm;
  axes.moment_s = axes.drawn_until_s = frame.time_s;
  axes.from_s = std::max(0.0, frame.time_s - 0.9 * kTorqueWindow_s);
  axes.to_s = axes.from_s + kTorqueWindow_s;
  draw_torques(canvas, moved({kTorques.x, kTorques.y + 5.0, kTorques.width, kTorques.height - 5.0}), torques, axes,
               12.0);

  const Rect bar = moved(kBar);
  const double length_s = std::max(frame.to_s - frame.from_s, 1e-9);
  const auto x_of = [&](double time_s) {
    return bar.x + bar.width * std::clamp((time_s - frame.from_s) / length_s, 0.0, 1.0);
  };
  canvas.fill(bar, kFaint);
  canvas.fill({bar.x, bar.y, x_of(frame.time_s) - bar.x, bar.height}, kFrame);
  for (const FilmMark& mark : marks) {
    if (mark.time_s < frame.from_s || mark.time_s > frame.to_s) continue;
    canvas.fill({x_of(mark.time_s) - 2.0, bar.y - 3.0, 4.0, bar.height + 6.0}, display_colour(mark.colour));
  }
  canvas.fill({x_of(frame.time_s) - 1.0, bar.y - 3.0, 2.0, bar.height + 6.0}, kInk);
}

}  // namespace constrictor::figure
