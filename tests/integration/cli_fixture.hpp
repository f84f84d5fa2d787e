// A fixture for tests that start runs and call commands on them. The registry of runs belongs to the test, so that the
// commands find no other run of this host.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "integration/case_study_manifest.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {

class CliFixture : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const { std::ofstream(dir_ / name) << text; }
  [[nodiscard]] Process start(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), program("constrictor"));
    return Process(std::move(arguments), environment_);
  }
  /// Runs a command and returns its exit status, or -1 if it does not end within `bound`. `output_` then holds its
  /// standard output and its standard error.
  int command(std::vector<std::string> arguments, std::chrono::seconds bound = std::chrono::seconds(30)) {
    Process process = start(std::move(arguments));
    const int status = process.wait(bound).value_or(-1);
    output_ = process.output() + process.errors();
    return status;
  }
  /// DDS domain of the only run of this test.
  [[nodiscard]] std::uint32_t domain() const {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(dir_)) {
      std::uint32_t number = 0;
      if (std::sscanf(entry.path().filename().c_str(), "run-%u.json", &number) == 1 &&
          entry.path().extension() == ".json")
        return number;
    }
    return 0;
  }
  [[nodiscard]] nlohmann::json report(const std::string& name) const {
    return nlohmann::json::parse(std::ifstream(dir_ / name / "report.json"), nullptr, false);
  }

  /// Files of the test's folder that a command has begun to write, as `NAME.PID.part`, with their sizes.
  [[nodiscard]] std::map<std::string, std::uintmax_t> unfinished() const {
    std::map<std::string, std::uintmax_t> files;
    for (const auto& entry : std::filesystem::directory_iterator(dir_)) {
      std::error_code gone;
      const std::string name = entry.path().filename();
      if (name.find(".part") != std::string::npos) files[name] = entry.file_size(gone);
    }
    return files;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path dir_ = folder_.path();
  std::map<std::string, std::string> environment_{{"XDG_RUNTIME_DIR", dir_.string()}};
  std::string output_;
};

}  // namespace constrictor::testing
