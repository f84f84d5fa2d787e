#include "sim/figure/png.hpp"

#include <png.h>
#include <zlib.h>

#include <csetjmp>
#include <stdexcept>

namespace constrictor {
namespace {

void append(png_structp png, png_bytep bytes, png_size_t size) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), size);
}

[[noreturn]] void keep_error(png_structp png, png_const_charp message) {
  *static_cast<std::string*>(png_get_error_ptr(png)) = message;
  png_longjmp(png, 1);
}

/// Runs are found in a small part of the time of a search for repetitions, and leave files of the same size: pictures
/// have noise, or large areas of one colour.
bool write(png_structp png, png_infop info, int width, int height, const std::uint8_t* rgb) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8, PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 1);
  png_set_compression_strategy(png, Z_RLE);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
  png_write_info(png, info);
  for (std::ptrdiff_t row = 0; row < height; ++row) png_write_row(png, rgb + 3 * row * width);
  png_write_end(png, info);
  return true;
}

}  // namespace

std::string encode_png(int width, int height, const std::uint8_t* rgb) {
  std::string bytes, error = "out of memory";
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, keep_error, nullptr);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  if (png != nullptr) png_set_write_fn(png, &bytes, append, nullptr);
  const bool written = info != nullptr && write(png, info, width, height, rgb);
  png_destroy_write_struct(&png, &info);
  if (!written) throw std::runtime_error("cannot encode a PNG image: " + error);
  return bytes;
}

}  // namespace constrictor
