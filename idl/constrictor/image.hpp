// The check that every reader of images makes before it uses their pixels.
#pragma once

#include <string>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Why the data of an image are not width * height RGB pixels: "data: found 3 bytes, accepted 2 x 2 x 3 = 12". Empty if
/// they are. Writers of images may be programs of other people.
[[nodiscard]] std::string image_violation(const msg::CameraImage& image);

}  // namespace constrictor
