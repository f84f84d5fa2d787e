// Compares the simulated physics with independent values and writes a report. scripts/validate_physics.sh runs it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "bench/validation/checks.hpp"

namespace {

using namespace constrictor::validation;

const std::vector<std::pair<std::string, Section (*)()>>& groups() {
  static const std::vector<std::pair<std::string, Section (*)()>> all{
      {"bodies", check_free_bodies},      {"slopes", check_slopes},      {"joints", check_joints},
      {"contacts", check_contact_forces}, {"energy", check_gait_energy}, {"servos", check_servos},
      {"planar", check_planar_model},     {"speeds", check_speeds},      {"mujoco", check_mujoco},
      {"convergence", check_convergence}};
  return all;
}

int run(const std::string& output, const std::vector<std::string>& only) {
  Results results;
  for (const auto& [name, check] : groups()) {
    if (!only.empty() && std::find(only.begin(), only.end(), name) == only.end()) continue;
    const auto begin = std::chrono::steady_clock::now();
    fmt::print("validate: {} ...\n", name);
    std::fflush(stdout);
    results.add(check());
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    fmt::print("validate: {} took {:.1f} s\n", name, took.count());
  }
  results.write(output);
  fmt::print("validate: {} required comparisons and {} aims missed; the report is {}/validation.md\n",
             results.required_misses(), results.missed_aims(), output);
  return results.required_misses() == 0 ? 0 : 1;
}

int parse_and_run(int argc, char** argv) {
  CLI::App app{"Compare the simulated physics with independent values. Exit status 1: a required comparison failed."};
  std::string output = "build/validation";
  std::vector<std::string> only;
  std::vector<std::string> names;
  for (const auto& group : groups()) names.push_back(group.first);
  app.add_option("--output", output, "Folder for validation.md, validation.json and the plots")->capture_default_str();
  app.add_option("--only", only, "Run only these groups")->check(CLI::IsMember(names));
  CLI11_PARSE(app, argc, argv);
  return run(output, only);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return parse_and_run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "validate: %s\n", error.what());
    return 2;
  }
}
