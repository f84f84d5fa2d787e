// Save and load of an object whose whole memory is one struct.
#pragma once

#include <cereal/archives/portable_binary.hpp>
#include <sstream>
#include <string>
#include <utility>

namespace constrictor {

/// Implements the virtual functions `std::string save() const` and `void load(const std::string& bytes)` of `Interface`
/// for an object whose whole state is one cereal-serialisable struct. The bytes do not depend on the machine. load()
/// throws cereal::Exception if the bytes end too early.
template <class Interface, class State>
class Stateful : public Interface {
 public:
  [[nodiscard]] std::string save() const final {
    std::ostringstream stream;
    cereal::PortableBinaryOutputArchive archive(stream);
    archive(state_);
    return std::move(stream).str();
  }
  void load(const std::string& bytes) final {
    std::istringstream stream(bytes);
    cereal::PortableBinaryInputArchive archive(stream);
    archive(state_);
  }

 protected:
  State state_{};
};

}  // namespace constrictor
