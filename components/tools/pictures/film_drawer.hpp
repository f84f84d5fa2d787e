// Draws the frames of a film, several at the same time.
#pragma once

#include <cstdint>
#include <deque>
#include <future>
#include <memory>
#include <vector>

#include "pictures/scene_painter.hpp"
#include "sim/figure/film_frame.hpp"

namespace constrictor::pictures {

/// The parts that all frames of a film share.
struct FilmStyle {
  int width = 0, height = 0;  ///< [pixel] of a frame
  figure::TorqueSeries torques;
  double limit_nm = 0.0;  ///< of the scale for torques
  std::vector<figure::FilmMark> marks;
};

/// Frames come out in the order in which they were begun. Their pixels do not depend on the number of threads.
class FilmDrawer {
 public:
  /// `threads` >= 1: how many frames are drawn at the same time; each needs a renderer of its own. Throws
  /// std::runtime_error if OpenGL fails. `style` must outlive the drawer.
  FilmDrawer(const RecordedStory& story, const FilmStyle& style, std::size_t threads);
  ~FilmDrawer();

  /// Whether all threads draw a frame: take() must then be called before the next begin().
  [[nodiscard]] bool full() const { return drawn_.size() == desks_.size(); }
  [[nodiscard]] bool empty() const { return drawn_.empty(); }
  /// Begins a frame. The pictures in `frame` are set here; everything else of it is the caller's.
  void begin(const Seen& seen, figure::FilmFrame frame);
  /// The pixels of the oldest frame that was begun: 4 bytes each, blue, green, red, unused; valid until the next
  /// begin(). Waits until it is done. Throws what drawing it has thrown.
  [[nodiscard]] const std::uint8_t* take();

 private:
  struct Desk;  // the canvas and data of one drawing thread
  const FilmStyle& style_;
  std::vector<std::unique_ptr<Desk>> desks_;
  std::size_t next_ = 0;
  std::deque<std::future<const std::uint8_t*>> drawn_;
};

}  // namespace constrictor::pictures
