#include "barrier/protocol.hpp"

namespace constrictor {
namespace {

void append_number(std::string& block, std::uint64_t number) {
  for (int shift = 0; shift < 64; shift += 8) block.push_back(static_cast<char>(number >> shift & 0xff));
}

/// Reads values from the front of a block. If the block is too short, `ok` becomes false and stays false.
struct BlockReader {
  std::string_view block;
  bool ok = true;

  std::string_view bytes(std::uint64_t size) {
    if (size > block.size()) {
      ok = false;
      return {};
    }
    const std::string_view taken = block.substr(0, size);
    block.remove_prefix(size);
    return taken;
  }
  std::uint64_t number() {
    std::uint64_t value = 0;
    int shift = 0;
    for (const char byte : bytes(8)) {
      value |= std::uint64_t{static_cast<unsigned char>(byte)} << shift;
      shift += 8;
    }
    return value;
  }
};

const std::string kScenario = "s:";
const std::string kConfiguration = " c:";
/// A hash is recognised by its first digits; several of them must fit into the reason of a refusal.
std::string shown(const std::string& text) {
  const bool hash = text.size() > 20 && text.find(' ') == std::string::npos;
  return hash ? text.substr(0, 12) + "..." : text;
}

constexpr std::size_t kHashDigits = 28;  // of each hash: all parts fit into the 64 characters of Hello.component_hash
constexpr const char* kReplaces = " r";

}  // namespace

std::string component_hash(const std::string& scenario, const std::string& configuration) {
  return kScenario + scenario.substr(0, kHashDigits) + kConfiguration + configuration.substr(0, kHashDigits);
}

std::string scenario_part(const std::string& component_hash) {
  const auto end = component_hash.find(kConfiguration);
  if (!component_hash.starts_with(kScenario) || end == std::string::npos) return {};
  return component_hash.substr(kScenario.size(), end - kScenario.size());
}

std::string replacing(const std::string& component_hash) { return component_hash + kReplaces; }

bool replaces(const std::string& component_hash) { return component_hash.ends_with(kReplaces); }

std::optional<std::string> difference(const Hello& hello, const Hello& ours) {
  std::string all;
  const auto compare = [&](const char* what, const std::string& theirs, const std::string& our) {
    if (theirs == our) return;
    all += std::string(all.empty() ? "" : "; ") + what + " differs: found " + shown(theirs) + ", the run has " +
           shown(our);
  };
  const auto compare_if_known = [&](const char* what, const std::string& theirs, const std::string& our) {
    if (!theirs.empty() && !our.empty()) compare(what, theirs, our);
  };
  compare("IDL hash", hello.idl_hash, ours.idl_hash);
  compare_if_known("release", hello.release, ours.release);
  compare("configuration hash", hello.config_hash, ours.config_hash);
  compare_if_known("scenario", scenario_part(hello.component_hash), scenario_part(ours.component_hash));
  compare("numeric profile", hello.numeric_profile, ours.numeric_profile);
  if (all.empty()) return {};
  return all;
}

std::string pack_checkpoint(const std::string& state, const std::vector<TickDone::Written>& outputs,
                            std::string memory) {
  std::string block = std::move(memory);
  block.clear();
  if (state.empty() && outputs.empty()) return block;
  std::size_t size = 2 * sizeof(std::uint64_t) + state.size();
  for (const auto& output : outputs) size += 1 + sizeof(std::uint64_t) + output.bytes.size();
  block.reserve(size);
  append_number(block, state.size());
  block += state;
  append_number(block, outputs.size());
  for (const auto& output : outputs) {
    block.push_back(static_cast<char>(output.topic));
    append_number(block, output.bytes.size());
    block += output.bytes;
  }
  return block;
}

bool unpack_checkpoint(std::string_view block, std::string& state, std::vector<TickDone::Written>& outputs) {
  BlockReader reader{block};
  state = block.empty() ? std::string_view() : reader.bytes(reader.number());
  const std::uint64_t count = block.empty() ? 0 : reader.number();
  std::uint64_t found = 0;
  for (; found < count && reader.ok; ++found) {
    if (found == outputs.size()) outputs.emplace_back();
    TickDone::Written& output = outputs[found];
    const std::string_view topic = reader.bytes(1);
    output.topic = topic.empty() ? std::uint8_t{0} : static_cast<std::uint8_t>(topic[0]);
    output.bytes = reader.bytes(reader.number());
    reader.ok &= output.topic < topics::kCount;
  }
  outputs.resize(found);
  if (reader.ok && reader.block.empty()) return true;
  state.clear();
  outputs.clear();
  return false;
}

}  // namespace constrictor
