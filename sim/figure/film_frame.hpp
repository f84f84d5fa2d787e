// A frame of the film of a run: the four panels of the figure at one time, and how far the run has come.
#pragma once

#include <string>
#include <vector>

#include "sim/figure/canvas.hpp"
#include "sim/figure/panels.hpp"

namespace constrictor::figure {

/// A mark on the bar at the lower edge.
struct FilmMark {
  double time_s = 0.0;
  std::uint8_t colour = 0;  ///< msg::kColour…
};

struct FilmFrame {
  double time_s = 0.0;            ///< simulated
  double from_s = 0.0, to_s = 0;  ///< of the run, for the bar
  std::string title;              ///< of the run
  std::string state;              ///< of the planner
  std::string event;              ///< the newest one, with its time; empty: there is none
  Picture scene, camera, processed;
};

/// Places of the parts of a frame, for frames of any size: in units, of which the smaller of width / 1280 and height /
/// 720 pixels are one.
inline constexpr double kFilmWidth = 1280.0, kFilmHeight = 720.0;
inline constexpr Rect kFilmScene{16.0, 78.0, 832.0, 400.0};

/// Draws over the whole canvas, which was made with the scale film_scale().
void draw_film_frame(Canvas& canvas, int width_px, int height_px, const FilmFrame& frame, const TorqueSeries& torques,
                     double limit_nm, const std::vector<FilmMark>& marks);

/// Pixels for each unit.
[[nodiscard]] double film_scale(int width_px, int height_px);

}  // namespace constrictor::figure
