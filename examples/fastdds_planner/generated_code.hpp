// Included before fastddsgen's sources: version 2.3 names the constants of array bounds without their namespace there.
#pragma once
namespace constrictor { namespace msg {} }
using namespace constrictor::msg;
