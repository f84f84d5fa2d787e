#include "sim/figure/figure_module.hpp"

#include <exception>

namespace {

using namespace constrictor::figure;

std::string draw_png(const Heading& heading, const std::vector<FileRow>& files, const std::string& torques_csv,
                     double window_s, std::string& error) {
  try {
    std::vector<Row> rows;
    for (const FileRow& file : files)
      rows.push_back({file.time_s, file.caption, file.state, file.colour, Picture::read_png(file.scene),
                      Picture::read_png(file.camera), Picture::read_png(file.processed)});
    return draw_figure(heading, rows, parse_torques(torques_csv), window_s, Format::kPng);
  } catch (const std::exception& caught) {
    error = caught.what();
    return {};
  }
}

}  // namespace

// A variable, because a function with C linkage must not return a C++ type.
extern "C" __attribute__((visibility("default"))) const DrawPng constrictor_draw_png;
const DrawPng constrictor_draw_png = draw_png;
