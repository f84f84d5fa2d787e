// The files of a run that its recording contains as attachments.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "recording/mcap_format.hpp"

namespace constrictor {

/// The file as an attachment with this name; empty if the file cannot be read.
[[nodiscard]] std::optional<mcap::Attachment> attached_file(const std::string& name, const std::filesystem::path& file);

/// The attachment versions.yaml: this release and its IDL, and the numeric profile and the libraries (name and version)
/// of the process that computes the run.
[[nodiscard]] mcap::Attachment attached_versions(const std::string& numeric_profile,
                                                 const std::vector<std::pair<std::string, std::string>>& libraries);

}  // namespace constrictor
