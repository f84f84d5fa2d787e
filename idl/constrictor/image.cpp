#include "constrictor/image.hpp"

#include <cstddef>

namespace constrictor {

std::string image_violation(const msg::CameraImage& image) {
  const auto size = [&] { return std::to_string(image.width) + " x " + std::to_string(image.height); };
  const std::size_t bytes = std::size_t{3} * image.width * image.height;
  if (bytes == 0) return "size: found " + size() + " pixels, accepted 1 x 1 or more";
  if (image.data._length == bytes && image.data._buffer != nullptr) return {};
  return "data: found " + std::to_string(image.data._length) + " bytes, accepted " + size() +
         " x 3 = " + std::to_string(bytes) + (image.data._buffer == nullptr ? " bytes in memory" : "");
}

}  // namespace constrictor
