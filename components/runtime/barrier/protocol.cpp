#include "runtime/barrier/protocol.hpp"

#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <stdexcept>

namespace constrictor {

template <class Archive>
void serialize(Archive& archive, StepDone::Written& written) {
  archive(written.topic, written.bytes);
}

std::string pack_outputs(const std::string& state, const std::vector<StepDone::Written>& outputs) {
  std::ostringstream stream;
  cereal::PortableBinaryOutputArchive archive(stream);
  archive(state, outputs);
  return std::move(stream).str();
}

void unpack_outputs(const std::string& block, std::string& state, std::vector<StepDone::Written>& outputs) {
  try {
    std::istringstream stream(block);
    cereal::PortableBinaryInputArchive archive(stream);
    archive(state, outputs);
  } catch (const std::exception& error) {
    throw std::runtime_error(std::string("damaged checkpoint: ") + error.what());
  }
}

}  // namespace constrictor
