#include "sim/figure/figure_module.hpp"

#include <exception>
#include <future>
#include <vector>

namespace {

using namespace constrictor::figure;

std::string draw_png(const Heading& heading, const std::vector<FileRow>& files, const std::string& torques_csv,
                     double window_s, std::string& error) {
  try {
    std::vector<std::future<Row>> coming;  // to read the pictures takes as long as to draw a third of the figure
    for (const FileRow& file : files)
      coming.push_back(std::async(std::launch::async, [&file] {
        return Row{file.time_s,
                   file.caption,
                   file.state,
                   file.colour,
                   Picture::read_png(file.scene),
                   Picture::read_png(file.camera),
                   Picture::read_png(file.processed)};
      }));
    std::vector<Row> rows;
    for (auto& row : coming) rows.push_back(row.get());
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
