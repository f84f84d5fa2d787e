#include "cli/evaluate/merge.hpp"

#include <fmt/format.h>

#include <set>
#include <system_error>

#include "cli/evaluate/evaluation_record.hpp"
#include "cli/run_record.hpp"
#include "cli/usage.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

/// Throws std::filesystem::filesystem_error; then nothing of the run is there.
void copy_run(const fs::path& from, const fs::path& to) {
  const fs::path beside = to.string() + ".part";  // renamed when it is complete
  try {
    fs::remove_all(to);
    fs::create_directories(to.parent_path());
    fs::remove_all(beside);
    fs::copy(from, beside, fs::copy_options::recursive);
    fs::rename(beside, to);
  } catch (const fs::filesystem_error&) {
    std::error_code ignored;
    fs::remove_all(beside, ignored);
    throw;
  }
}

}  // namespace

std::vector<std::uint64_t> seeds_of(const std::vector<fs::path>& folders) {
  std::set<std::uint64_t> seeds;
  for (const auto& folder : folders) {
    const auto found = read_record(folder);
    if (!found) throw UsageError(fmt::format("--merge: {} holds no evaluation", folder.string()));
    seeds.insert(found->seeds.begin(), found->seeds.end());
  }
  return {seeds.begin(), seeds.end()};
}

std::vector<std::string> merge_evaluations(const std::vector<fs::path>& folders, const EvaluationRequest& request) {
  const RunOptions options = absolute_options(request.run, make_launch_plan(request.run));
  const EvaluationRecord wanted{"", request.vary, {}, identities_of(options)};
  for (const auto& folder : folders) {
    const auto found = read_record(folder);
    const std::string why = found ? difference(*found, wanted) : "it holds none";
    if (!why.empty()) throw UsageError(fmt::format("--merge: {} holds another evaluation: {}", folder.string(), why));
  }
  std::vector<std::string> failures;
  for (const auto& folder : folders) {
    const fs::path runs = folder / "runs";
    if (!fs::exists(runs) || fs::equivalent(folder, request.folder)) continue;
    for (const auto& variant : fs::directory_iterator(runs)) {
      for (const auto& run : fs::directory_iterator(variant.path())) {
        if (!fs::exists(run.path() / "outcome.json")) continue;  // not over
        const fs::path to = request.folder / "runs" / variant.path().filename() / run.path().filename();
        if (fs::exists(to / "outcome.json")) continue;
        try {
          copy_run(run.path(), to);
        } catch (const fs::filesystem_error& error) {
          failures.push_back(fmt::format("{} was not copied: {}", run.path().string(), error.code().message()));
        }
      }
    }
  }
  return failures;
}

}  // namespace constrictor::cli
