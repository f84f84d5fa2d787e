#include "sim/report/png.hpp"

#include <png.h>

#include <stdexcept>

namespace constrictor::report {

std::string encode_png(const cv::Mat& bgr) {
  CV_Assert(bgr.type() == CV_8UC3 && !bgr.empty());
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(bgr.cols);
  header.height = static_cast<png_uint_32>(bgr.rows);
  header.format = PNG_FORMAT_BGR;
  header.flags = PNG_IMAGE_FLAG_FAST;
  const auto row_stride = static_cast<png_int_32>(bgr.step[0]);
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, bgr.data, row_stride, nullptr) == 0)
    throw std::runtime_error(std::string("cannot encode a PNG image: ") + header.message);
  bytes.resize(size);
  return bytes;
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
