#include "sim/world/state_hash.hpp"

#include "constrictor/sha256.hpp"

namespace constrictor {

void StateHash::extend(std::span<const double> values) {
  Sha256 hash;
  hash.update(std::as_bytes(std::span(digest_)));
  hash.update(std::as_bytes(values));
  digest_ = hash.finish();
}

}  // namespace constrictor
