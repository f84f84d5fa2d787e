// Packages of npm that tests need.
#pragma once

#include <gtest/gtest.h>
#include <sys/file.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "support/process.hpp"

namespace constrictor::testing {

/// Copies these files of the folder `source`, of which one is package.json, into the folder `target`, and installs the
/// packages there. Tests that share `target` may do so at the same time.
inline void install_npm_packages(const std::filesystem::path& source, const std::vector<std::string>& files,
                                 const std::filesystem::path& target) {
  std::filesystem::create_directories(target);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> lock(std::fopen((target / "lock").c_str(), "we"), &std::fclose);
  ASSERT_TRUE(lock);
  ASSERT_EQ(::flock(::fileno(lock.get()), LOCK_EX), 0);
  for (const std::string& file : files)
    std::filesystem::copy_file(source / file, target / file, std::filesystem::copy_options::overwrite_existing);
  Process npm({"npm", "install", "--no-audit", "--no-fund", "--prefix", target.string()});
  ASSERT_EQ(npm.wait(std::chrono::seconds(300)), 0) << npm.errors();
}

}  // namespace constrictor::testing
