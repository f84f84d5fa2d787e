#include "component/component.hpp"

namespace constrictor {

std::uint64_t Setup::component_seed() const {
  // FNV-1a over the name, then splitmix64: fixed on every platform, unlike std::hash.
  std::uint64_t hash = 0xcbf29ce484222325ULL ^ seed;
  for (const char letter : component) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3ULL;
  }
  hash += 0x9e3779b97f4a7c15ULL;
  hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9ULL;
  hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebULL;
  return hash ^ (hash >> 31);
}

}  // namespace constrictor
