// A `constrictor run` for tests on another vendor's DDS: its domain, its report.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::testing {

class RosBridge : public ::testing::Test {
 protected:
  [[nodiscard]] Process run(const std::string& name, const std::string& scenario, std::vector<std::string> more) const {
    std::vector<std::string> arguments = {program("constrictor"), "run", scenario, "--report", (dir_ / name).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Process(std::move(arguments));
  }
  [[nodiscard]] nlohmann::json report(const std::string& name) const {
    return nlohmann::json::parse(std::ifstream(dir_ / name / "report.json"), nullptr, false);
  }

  const TemporaryFolder folder_;
  const std::filesystem::path dir_ = folder_.path();
};

}  // namespace constrictor::testing
