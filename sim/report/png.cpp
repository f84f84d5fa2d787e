#include "sim/report/png.hpp"

#include <png.h>

#include <stdexcept>

namespace constrictor::report {

namespace {

std::string encode(int width, int height, png_uint_32 format, const std::uint8_t* pixels, std::size_t row_stride) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(width);
  header.height = static_cast<png_uint_32>(height);
  header.format = format;
  header.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  const auto stride = static_cast<png_int_32>(row_stride);
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, pixels, stride, nullptr) == 0)
    throw std::runtime_error(std::string("cannot encode a PNG image: ") + header.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace

std::string encode_png(const cv::Mat& bgr) {
  CV_Assert(bgr.type() == CV_8UC3 && !bgr.empty());
  return encode(bgr.cols, bgr.rows, PNG_FORMAT_BGR, bgr.data, bgr.step[0]);
}

std::string encode_png(int width, int height, const std::uint8_t* rgb) {
  return encode(width, height, PNG_FORMAT_RGB, rgb, static_cast<std::size_t>(3) * static_cast<std::size_t>(width));
}

cv::Mat read_png(const std::filesystem::path& file) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_file(&header, file.c_str()) == 0) return {};
  header.format = PNG_FORMAT_BGR;
  cv::Mat bgr(static_cast<int>(header.height), static_cast<int>(header.width), CV_8UC3);
  const auto row_stride = static_cast<png_int_32>(bgr.step[0]);
  if (png_image_finish_read(&header, nullptr, bgr.data, row_stride, nullptr) == 0) return {};
  return bgr;
}

}  // namespace constrictor::report
