#include "sim/figure/lazy_figure.hpp"

#include <stdexcept>

#include "configuration/lazy_module.hpp"
#include "sim/figure/figure_module.hpp"

namespace constrictor::figure {

std::string draw_png_lazily(const Heading& heading, const std::vector<FileRow>& rows, const std::string& torques_csv,
                            double window_s) {
  const auto draw = lazy_variable<DrawPng>(kFigureModule, kDrawPng, "the figure");
  std::string error;
  std::string bytes = draw(heading, rows, torques_csv, window_s, error);
  if (!error.empty()) throw std::runtime_error(error);
  return bytes;
}

}  // namespace constrictor::figure
