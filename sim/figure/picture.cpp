// Pictures on a canvas, and the formats of files.
#include <cairo.h>

#include <algorithm>
#include <cctype>

#include "sim/figure/cairo_status.hpp"
#include "sim/figure/canvas.hpp"

namespace constrictor::figure {

std::optional<Format> format_of(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".png") return Format::kPng;
  if (ending == ".svg") return Format::kSvg;
  if (ending == ".pdf") return Format::kPdf;
  return std::nullopt;
}

Picture::Picture(int width, int height, const std::uint8_t* rgb) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
  require(cairo_surface_status(surface));
  surface_ = {surface, [](void* one) { cairo_surface_destroy(static_cast<cairo_surface_t*>(one)); }};
  cairo_surface_flush(surface);
  unsigned char* data = cairo_image_surface_get_data(surface);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
  for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
    unsigned char* to = data + y * stride;
    for (int x = 0; x < width; ++x, rgb += 3, to += 4) {
      to[0] = rgb[2];
      to[1] = rgb[1];
      to[2] = rgb[0];
      to[3] = 255;
    }
  }
  cairo_surface_mark_dirty(surface);
}

Picture Picture::read_png(const std::filesystem::path& file) {
  Picture picture;
  cairo_surface_t* surface = cairo_image_surface_create_from_png(file.c_str());
  if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS) {
    cairo_surface_destroy(surface);
    return picture;
  }
  picture.surface_ = {surface, [](void* one) { cairo_surface_destroy(static_cast<cairo_surface_t*>(one)); }};
  return picture;
}

}  // namespace constrictor::figure
