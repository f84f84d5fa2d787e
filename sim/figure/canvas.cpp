#include "sim/figure/canvas.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <fmt/format.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "configuration/xml_escaped.hpp"
#include "constrictor/text.hpp"
#include "sim/figure/cairo_status.hpp"
#include "sim/figure/png.hpp"

namespace constrictor::figure {
namespace {

constexpr const char* kFamily = "DejaVu Sans";
// A viewer without this font takes one of about the same width.
constexpr const char* kFamilies = "DejaVu Sans, Verdana, Arial, sans-serif";

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

std::string hex(const Colour& colour) {
  const auto byte = [](double value) { return static_cast<int>(std::lround(255.0 * std::clamp(value, 0.0, 1.0))); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour.red), byte(colour.green), byte(colour.blue));
}

cairo_surface_t* surface_for(Format format, double width, double height, double scale, std::string& bytes) {
  const double w = width * scale, h = height * scale;
  switch (format) {
    case Format::kSvg: {
      cairo_surface_t* surface = cairo_svg_surface_create_for_stream(append, &bytes, w, h);
      cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
      return surface;
    }
    case Format::kPdf:
      return cairo_pdf_surface_create_for_stream(append, &bytes, w, h);
    default:
      return cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::ceil(w)),
                                        static_cast<int>(std::ceil(h)));
  }
}

/// The pixels of an image surface without gaps, red first. Cairo stores a pixel as a number of 32 bits.
std::vector<std::uint8_t> rgb_of(const std::uint8_t* pixels, cairo_surface_t* surface) {
  const int width = cairo_image_surface_get_width(surface);
  const int height = cairo_image_surface_get_height(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(static_cast<std::size_t>(3 * width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::uint32_t pixel = 0;
      std::memcpy(&pixel, pixels + static_cast<std::ptrdiff_t>(y) * stride + static_cast<std::ptrdiff_t>(x) * 4,
                  sizeof pixel);
      for (const unsigned shift : {16U, 8U, 0U}) rgb.push_back(static_cast<std::uint8_t>(pixel >> shift));
    }
  }
  return rgb;
}

/// Removes the last character of UTF-8.
void pop_character(std::string& words) {
  while (!words.empty() && (static_cast<unsigned char>(words.back()) & 0xC0) == 0x80) words.pop_back();
  if (!words.empty()) words.pop_back();
}

}  // namespace

struct Canvas::Parts {
  std::optional<Format> format;  ///< empty: pixels
  std::string bytes;
  double scale = 1.0;
  cairo_surface_t* surface = nullptr;
  cairo_t* cairo = nullptr;
  PangoLayout* layout = nullptr;
  std::string texts;  ///< elements of an SVG file: Cairo 1.16 would draw outlines, not editable text

  void begin() {
    require(cairo_surface_status(surface));
    cairo = cairo_create(surface);
    require(cairo_status(cairo));
    cairo_scale(cairo, scale, scale);
    // Hinting is off, also if the user's fontconfig switches it on: glyphs have the same positions in each format and
    // size.
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    layout = pango_cairo_create_layout(cairo);
    pango_cairo_context_set_font_options(pango_layout_get_context(layout), options);
    pango_cairo_context_set_resolution(pango_layout_get_context(layout), 72.0);
    cairo_font_options_destroy(options);
    pango_layout_set_single_paragraph_mode(layout, TRUE);
  }
  ~Parts() {
    if (layout != nullptr) g_object_unref(layout);
    if (cairo != nullptr) cairo_destroy(cairo);
    if (surface != nullptr) cairo_surface_destroy(surface);
  }
  void set(std::string_view words, const TextStyle& style) {
    PangoFontDescription* font = pango_font_description_new();
    pango_font_description_set_family_static(font, kFamily);
    pango_font_description_set_weight(font, style.bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
    pango_font_description_set_absolute_size(font, style.size * PANGO_SCALE);
    pango_layout_set_font_description(layout, font);
    pango_font_description_free(font);
    pango_layout_set_text(layout, words.data(), static_cast<int>(words.size()));
  }
  [[nodiscard]] double width() const {
    int width = 0;
    pango_layout_get_size(layout, &width, nullptr);
    return static_cast<double>(width) / PANGO_SCALE;
  }
  void set_source(const Colour& colour) const { cairo_set_source_rgb(cairo, colour.red, colour.green, colour.blue); }
};

Canvas::Canvas(Format format, double width, double height, double scale, const std::string& title)
    : parts_(std::make_unique<Parts>()) {
  parts_->format = format;
  parts_->scale = scale;
  parts_->surface = surface_for(format, width, height, scale, parts_->bytes);
  parts_->begin();
  if (format == Format::kPdf) {
    cairo_pdf_surface_set_metadata(parts_->surface, CAIRO_PDF_METADATA_TITLE, printable(title).c_str());
    cairo_pdf_surface_set_metadata(parts_->surface, CAIRO_PDF_METADATA_CREATOR, "Constrictor");
    // The same recording gives the same bytes at any time.
    cairo_pdf_surface_set_metadata(parts_->surface, CAIRO_PDF_METADATA_CREATE_DATE, "2000-01-01T00:00:00Z");
  }
  fill({0, 0, width, height}, kWhite);
}

Canvas::Canvas(int width_px, int height_px, double scale) : parts_(std::make_unique<Parts>()) {
  parts_->scale = scale;
  parts_->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width_px, height_px);
  parts_->begin();
  fill({0, 0, width_px / scale, height_px / scale}, kWhite);
}

Canvas::~Canvas() = default;

void Canvas::fill(const Rect& area, const Colour& colour) {
  parts_->set_source(colour);
  cairo_rectangle(parts_->cairo, area.x, area.y, area.width, area.height);
  cairo_fill(parts_->cairo);
}

void Canvas::frame(const Rect& area, const Colour& colour, double width) {
  parts_->set_source(colour);
  cairo_set_line_width(parts_->cairo, width);
  cairo_rectangle(parts_->cairo, area.x, area.y, area.width, area.height);
  cairo_stroke(parts_->cairo);
}

void Canvas::line(const Point& from, const Point& to, const Colour& colour, double width) {
  parts_->set_source(colour);
  cairo_set_line_width(parts_->cairo, width);
  cairo_move_to(parts_->cairo, from.x, from.y);
  cairo_line_to(parts_->cairo, to.x, to.y);
  cairo_stroke(parts_->cairo);
}

void Canvas::polyline(const std::vector<Point>& points, const Rect& clip, const Colour& colour, double width) {
  if (points.size() < 2) return;
  cairo_t* cairo = parts_->cairo;
  cairo_save(cairo);
  cairo_rectangle(cairo, clip.x, clip.y, clip.width, clip.height);
  cairo_clip(cairo);
  parts_->set_source(colour);
  cairo_set_line_width(cairo, width);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_BEVEL);
  for (const Point& point : points) cairo_line_to(cairo, point.x, point.y);
  cairo_stroke(cairo);
  cairo_restore(cairo);
}

void Canvas::picture(const Rect& area, const Picture& picture) {
  if (picture.empty()) return;
  cairo_t* cairo = parts_->cairo;
  auto* surface = static_cast<cairo_surface_t*>(picture.surface_.get());
  const double width = cairo_image_surface_get_width(surface), height = cairo_image_surface_get_height(surface);
  const double zoom = std::max(area.width / width, area.height / height);
  cairo_save(cairo);
  cairo_rectangle(cairo, area.x, area.y, area.width, area.height);
  cairo_clip(cairo);
  cairo_translate(cairo, area.x + 0.5 * (area.width - zoom * width), area.y + 0.5 * (area.height - zoom * height));
  cairo_scale(cairo, zoom, zoom);
  cairo_set_source_surface(cairo, surface, 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cairo), parts_->format ? CAIRO_FILTER_BEST : CAIRO_FILTER_GOOD);
  cairo_pattern_set_extend(cairo_get_source(cairo), CAIRO_EXTEND_PAD);  // no blending with nothing at the border
  cairo_paint(cairo);
  cairo_restore(cairo);
}

void Canvas::text(std::string_view words, const Point& at, const TextStyle& style) {
  const std::string clean = printable(std::string(words));
  parts_->set(clean, style);
  const double width = parts_->width();
  double x = at.x;
  if (style.align == Align::kCentre) x -= 0.5 * width;
  if (style.align == Align::kRight) x -= width;
  if (parts_->format == Format::kSvg) {
    // textLength: the text keeps its place also in another font.
    parts_->texts += fmt::format(
        "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.2f}\"{} fill=\"{}\" textLength=\"{:.2f}\" "
        "lengthAdjust=\"spacingAndGlyphs\">{}</text>\n",
        x, at.y, style.size, style.bold ? " font-weight=\"bold\"" : "", hex(style.colour), width, xml_escaped(clean));
    return;
  }
  parts_->set_source(style.colour);
  cairo_move_to(parts_->cairo, x, at.y);
  pango_cairo_show_layout_line(parts_->cairo, pango_layout_get_line_readonly(parts_->layout, 0));
}

double Canvas::width_of(std::string_view words, const TextStyle& style) {
  parts_->set(printable(std::string(words)), style);
  return parts_->width();
}

std::string Canvas::fitted(std::string_view words, double width, const TextStyle& style) {
  std::string shown = printable(std::string(words.substr(0, 1000)));  // no figure has room for more
  if (shown.size() == words.size() && width_of(shown, style) <= width) return shown;
  while (!shown.empty() && width_of(shown + "…", style) > width) pop_character(shown);
  return shown + "…";
}

std::vector<std::string> Canvas::wrapped(std::string_view words, double width, const TextStyle& style) {
  std::vector<std::string> lines;
  std::string rest = printable(std::string(words.substr(0, 1000)));
  while (!rest.empty()) {
    std::string line = rest;
    while (width_of(line, style) > width) {
      const std::size_t space = line.rfind(' ');
      if (space != std::string::npos && space > 0) line.resize(space);
      else pop_character(line);
    }
    if (line.empty()) break;  // not even one character fits
    lines.push_back(line);
    rest.erase(0, line.size());
    rest.erase(0, std::min(rest.find_first_not_of(' '), rest.size()));
  }
  return lines;
}

std::string Canvas::finish() {
  require(cairo_status(parts_->cairo));
  if (parts_->format == Format::kPng) {
    // Cairo itself would save another tenth of the bytes, but take five times as long to compress as to draw.
    return encode_png(cairo_image_surface_get_width(parts_->surface), cairo_image_surface_get_height(parts_->surface),
                      rgb_of(pixels(), parts_->surface).data());
  }
  cairo_surface_finish(parts_->surface);
  require(cairo_surface_status(parts_->surface));
  std::string bytes = std::move(parts_->bytes);
  if (parts_->format == Format::kSvg) {
    const std::size_t end = bytes.rfind("</svg>");
    if (end == std::string::npos) throw std::runtime_error("cannot draw: Cairo made no SVG file");
    bytes.insert(end, fmt::format("<g transform=\"scale({:.6g})\" font-family=\"{}\">\n{}</g>\n", parts_->scale,
                                  kFamilies, parts_->texts));
  }
  return bytes;
}

const std::uint8_t* Canvas::pixels() {
  require(cairo_status(parts_->cairo));
  cairo_surface_flush(parts_->surface);
  return cairo_image_surface_get_data(parts_->surface);
}

}  // namespace constrictor::figure
