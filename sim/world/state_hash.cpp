#include "sim/world/state_hash.hpp"

namespace constrictor {

void StateHash::extend(std::span<const double> values) {
  hash_.update(std::as_bytes(std::span(digest_)));
  hash_.update(std::as_bytes(values));
  digest_ = hash_.finish();
}

}  // namespace constrictor
