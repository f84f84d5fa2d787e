// The official reader of MCAP files, as a process of Node.js.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "support/npm_packages.hpp"
#include "support/process.hpp"

namespace constrictor::testing {

/// Reads MCAP files with npm's @mcap/core. Its packages are installed once into the build folder.
class OfficialReader {
 public:
  /// `source`: the folder of this file. `build`: the build folder.
  OfficialReader(const std::filesystem::path& source, const std::filesystem::path& build)
      : folder_(build / "recording_reader") {
    install_npm_packages(source, {"package.json", "read.mjs"}, folder_);
  }
  /// The lines that read.mjs prints. `stream`: the file need not be finished.
  [[nodiscard]] std::vector<nlohmann::json> read(const std::filesystem::path& file, bool stream = false) const {
    std::vector<std::string> arguments = {"node", (folder_ / "read.mjs").string(), file.string()};
    if (stream) arguments.emplace_back("stream");
    Process node(arguments);
    EXPECT_EQ(node.wait(std::chrono::seconds(100)), 0) << node.errors();
    std::vector<nlohmann::json> lines;
    std::istringstream output(node.output());
    for (std::string line; std::getline(output, line);) lines.push_back(nlohmann::json::parse(line));
    return lines;
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace constrictor::testing
