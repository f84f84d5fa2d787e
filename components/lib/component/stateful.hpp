// Save and load of an object whose whole memory is one struct.
#pragma once

#include <string>

#include "constrictor/archive.hpp"

namespace constrictor {

/// Implements the virtual functions `std::string save() const` and `void load(const std::string& bytes)` of `Interface`
/// for an object whose whole state is one cereal-serialisable struct. load() throws cereal::Exception if the bytes end
/// too early.
template <class Interface, class State>
class Stateful : public Interface {
 public:
  [[nodiscard]] std::string save() const final { return save_bytes(state_); }
  void load(const std::string& bytes) final { load_bytes(bytes, state_); }

 protected:
  State state_{};
};

}  // namespace constrictor
