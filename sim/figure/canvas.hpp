// A canvas of Cairo on which the same calls make a PNG, SVG or PDF file, or the pixels of a film's frame. Text is set
// by Pango in the font DejaVu Sans.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace constrictor::figure {

enum class Format { kPng, kSvg, kPdf };
/// The format of a name's ending, .png, .svg or .pdf in any case; empty: another ending.
[[nodiscard]] std::optional<Format> format_of(const std::filesystem::path& file);

struct Colour {
  double red = 0.0, green = 0.0, blue = 0.0;  ///< 0 to 1
};
inline constexpr Colour kWhite{1.0, 1.0, 1.0};
inline constexpr Colour kInk{0.15, 0.16, 0.18};
inline constexpr Colour kGreyInk{0.40, 0.41, 0.42};
inline constexpr Colour kRedInk{0.72, 0.14, 0.14};
inline constexpr Colour kFaint{0.89, 0.89, 0.90};
inline constexpr Colour kFrame{0.72, 0.73, 0.74};

struct Point {
  double x = 0.0, y = 0.0;
};
struct Rect {
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};
enum class Align { kLeft, kCentre, kRight };

struct TextStyle {
  double size = 13.0;  ///< of the font; a capital has about 0.73 of it
  Colour colour = kInk;
  bool bold = false;
  Align align = Align::kLeft;
};

/// Pixels, red first, 8 bits, in rows from the top.
class Picture {
 public:
  Picture() = default;  ///< empty
  /// Copies width * height * 3 bytes.
  Picture(int width, int height, const std::uint8_t* rgb);
  /// Reads a PNG file. Empty if it is missing or no PNG file.
  static Picture read_png(const std::filesystem::path& file);

  [[nodiscard]] bool empty() const { return surface_ == nullptr; }

 private:
  friend class Canvas;
  std::shared_ptr<void> surface_;  // cairo_surface_t
};

/// Positions and sizes are in units of the drawing, y downwards. Functions throw std::runtime_error if Cairo fails.
class Canvas {
 public:
  /// A file of `width` x `height` units, each of which is `scale` pixels (PNG, SVG) or points (PDF). `title`: of the
  /// document.
  Canvas(Format format, double width, double height, double scale, const std::string& title);
  /// Pixels to be read by pixels(), each unit `scale` of them.
  Canvas(int width_px, int height_px, double scale);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  void fill(const Rect& area, const Colour& colour);
  void frame(const Rect& area, const Colour& colour, double width);
  void line(const Point& from, const Point& to, const Colour& colour, double width);
  /// Only what lies in `clip` is drawn.
  void polyline(const std::vector<Point>& points, const Rect& clip, const Colour& colour, double width);
  /// Fills the area. A picture of another shape is cut at two sides, never stretched.
  void picture(const Rect& area, const Picture& picture);

  /// One line of text with its baseline at `at`.
  void text(std::string_view words, const Point& at, const TextStyle& style);
  /// `words`, cut at the end and marked with "…" if they are wider than `width`.
  [[nodiscard]] std::string fitted(std::string_view words, double width, const TextStyle& style);
  /// Breaks `words` at spaces, and a word that is too long anywhere, into lines of at most `width`.
  [[nodiscard]] std::vector<std::string> wrapped(std::string_view words, double width, const TextStyle& style);
  [[nodiscard]] double width_of(std::string_view words, const TextStyle& style);

  /// The bytes of the file. Nothing may be drawn afterwards.
  [[nodiscard]] std::string finish();
  /// Rows from the top of 4 bytes for each pixel: blue, green, red, unused. Valid until something is drawn.
  [[nodiscard]] const std::uint8_t* pixels();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace constrictor::figure
