// Included before the sources that fastddsgen 2.3 generates: they use constants in array bounds without the namespace.
#pragma once
namespace constrictor {
namespace msg {}
}  // namespace constrictor
using namespace constrictor::msg;
