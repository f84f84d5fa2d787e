// A drawn image as a message.
#pragma once

#include <cstdint>
#include <vector>

#include "constrictor/messages.hpp"
#include "sim/render/scene.hpp"

namespace constrictor {

/// Refers to the bytes of `rgb` (RGB8 rows from the top), which must stay unchanged until the message has been written.
[[nodiscard]] inline msg::CameraImage image_message(const PinholeCamera& camera, std::vector<std::uint8_t>& rgb,
                                                    std::int64_t exposure_tick) {
  msg::CameraImage image{};
  image.width = static_cast<std::uint16_t>(camera.width);
  image.height = static_cast<std::uint16_t>(camera.height);
  image.exposure_tick = exposure_tick;
  image.data._buffer = rgb.data();
  image.data._length = static_cast<std::uint32_t>(rgb.size());
  image.data._maximum = image.data._length;
  return image;
}

}  // namespace constrictor
