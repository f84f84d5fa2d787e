#include "sim/figure/png.hpp"

#include <png.h>

#include <stdexcept>

namespace constrictor {

std::string encode_png(int width, int height, const std::uint8_t* rgb) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(width);
  header.height = static_cast<png_uint_32>(height);
  header.format = PNG_FORMAT_RGB;
  header.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, rgb, 3 * width, nullptr) == 0)
    throw std::runtime_error(std::string("cannot encode a PNG image: ") + header.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace constrictor
