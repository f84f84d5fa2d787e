// What the plots have in common: colours, text, and a canvas that is drawn at twice its size and then
// reduced, which smooths the stroke fonts of OpenCV. All positions and sizes are pixels of the final figure.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace constrictor::validation {

inline constexpr int kScale = 2;
inline const cv::Scalar kInk(45, 40, 38);  // blue, green, red
inline const cv::Scalar kGreyInk(125, 120, 118);
inline const cv::Scalar kRedInk(40, 40, 190);
inline const cv::Scalar kFaint(228, 226, 225);
inline const cv::Scalar kFrame(196, 192, 190);

/// A white canvas for a figure of this size.
[[nodiscard]] cv::Mat make_canvas(int width, int height);
/// The figure, 8-bit BGR, in its final size.
[[nodiscard]] cv::Mat reduced(const cv::Mat& canvas);

/// A position of the figure on the canvas.
[[nodiscard]] cv::Point scaled(double x, double y);
[[nodiscard]] cv::Rect scaled_rect(int x, int y, int width, int height);

enum class Align { kLeft, kCentre, kRight };

/// Text with its baseline at y. `size` 1 gives capitals of about 11 pixels in the final figure.
void text(cv::Mat& canvas, const std::string& words, double x, double y, double size, const cv::Scalar& colour,
          bool bold = false, Align align = Align::kLeft);

/// `words`, cut at the end and marked with "..." if they are wider than `width`.
[[nodiscard]] std::string fitted(std::string words, double size, double width);

[[nodiscard]] std::string number(double value, int decimals);

}  // namespace constrictor::validation
