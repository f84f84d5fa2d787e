#include "pictures/film_drawer.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace constrictor::pictures {
namespace {

int scaled(double length, double scale) { return static_cast<int>(std::lround(scale * length)); }

}  // namespace

struct FilmDrawer::Desk {
  Desk(const RecordedStory& story, int width, int height, double scale)
      : painter(story, scaled(figure::kFilmScene.width, scale), scaled(figure::kFilmScene.height, scale)),
        canvas(width, height, scale) {}
  ScenePainter painter;
  figure::Canvas canvas;
};

FilmDrawer::FilmDrawer(const RecordedStory& story, const FilmStyle& style, std::size_t threads) : style_(style) {
  const double scale = figure::film_scale(style.width, style.height);
  for (std::size_t i = 0; i < threads; ++i)
    desks_.push_back(std::make_unique<Desk>(story, style.width, style.height, scale));
}

FilmDrawer::~FilmDrawer() = default;  // the futures wait for the threads, before the desks are gone

void FilmDrawer::begin(const Seen& seen, figure::FilmFrame frame) {
  if (full()) throw std::logic_error("FilmDrawer: begin() was called while all threads draw; call take() first");
  Desk& desk = *desks_[next_];
  next_ = (next_ + 1) % desks_.size();
  drawn_.push_back(std::async(std::launch::async, [this, &desk, seen, frame = std::move(frame)]() mutable {
    frame.scene = desk.painter.scene(seen);
    frame.camera = picture_of(seen.camera);
    frame.processed = picture_of(seen.processed);
    figure::draw_film_frame(desk.canvas, style_.width, style_.height, frame, style_.torques, style_.limit_nm,
                            style_.marks);
    return desk.canvas.pixels();
  }));
}

const std::uint8_t* FilmDrawer::take() {
  std::future<const std::uint8_t*> oldest = std::move(drawn_.front());
  drawn_.pop_front();
  return oldest.get();
}

}  // namespace constrictor::pictures
