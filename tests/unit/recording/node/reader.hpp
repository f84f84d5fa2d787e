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

#include "support/process.hpp"

namespace constrictor::testing {

/// Reads MCAP files with npm's @mcap/core. Its packages are installed once into the build folder.
class OfficialReader {
 public:
  /// `source`: the folder of this file. `build`: the build folder.
  OfficialReader(const std::filesystem::path& source, const std::filesystem::path& build)
      : folder_(build / "recording_reader") {
    std::filesystem::create_directories(folder_);
    for (const char* name : {"package.json", "read.mjs"}) {
      std::filesystem::copy_file(source / name, folder_ / name, std::filesystem::copy_options::overwrite_existing);
    }
    Process npm({"npm", "install", "--no-audit", "--no-fund", "--prefix", folder_.string()});
    EXPECT_EQ(npm.wait(std::chrono::seconds(200)), 0) << npm.errors();
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
