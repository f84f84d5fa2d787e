// The interface between the module of the figure and its user. Both are built together, so that C++ types may cross.
#pragma once

#include <string>
#include <vector>

#include "sim/figure/lazy_figure.hpp"

namespace constrictor::figure {

inline constexpr const char* kFigureModule = "constrictor_figure.so";  // beside the programs
inline constexpr const char* kDrawPng = "constrictor_draw_png";
/// `error`: empty, or why nothing was drawn.
using DrawPng = std::string (*)(const Heading& heading, const std::vector<FileRow>& rows,
                                const std::string& torques_csv, double window_s, std::string& error);

}  // namespace constrictor::figure
