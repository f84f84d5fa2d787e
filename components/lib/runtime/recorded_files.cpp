#include "runtime/recorded_files.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "constrictor/messages.hpp"
#include "runtime/version.hpp"

namespace constrictor {

std::optional<mcap::Attachment> attached_file(const std::string& name, const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  return mcap::Attachment{0, name, name.ends_with(".yaml") ? "application/yaml" : "text/plain",
                          std::string(std::istreambuf_iterator<char>(stream), {})};
}

mcap::Attachment attached_versions(const std::string& numeric_profile,
                                   const std::vector<std::pair<std::string, std::string>>& libraries) {
  std::string text = fmt::format("constrictor: {}\nidl_hash: {}\nnumeric_profile: {}\nlibraries:\n", kVersion,
                                 std::string(msg::kIdlHash), numeric_profile);
  for (const auto& [name, version] : libraries) text += fmt::format("  {}: {}\n", name, version);
  return {0, "versions.yaml", "application/yaml", text};
}

}  // namespace constrictor
