// Included before the sources that fastddsgen 2.3 generates. These sources use constants as array bounds, but omit the
// namespace of the constants.
#pragma once
namespace constrictor {
namespace msg {}
}  // namespace constrictor
using namespace constrictor::msg;
