#include "cli/evaluate/merge.hpp"

#include <fmt/format.h>

#include <set>

#include "cli/evaluate/evaluation_record.hpp"
#include "cli/run_record.hpp"
#include "cli/usage.hpp"

namespace constrictor::cli {

namespace fs = std::filesystem;

std::vector<std::uint64_t> seeds_of(const std::vector<fs::path>& folders) {
  std::set<std::uint64_t> seeds;
  for (const auto& folder : folders) {
    const auto found = read_record(folder);
    if (!found) throw UsageError(fmt::format("--merge: {} holds no evaluation", folder.string()));
    seeds.insert(found->seeds.begin(), found->seeds.end());
  }
  return {seeds.begin(), seeds.end()};
}

void merge_evaluations(const std::vector<fs::path>& folders, const EvaluationRequest& request) {
  const RunOptions options = absolute_options(request.run, make_launch_plan(request.run));
  const EvaluationRecord wanted{"", request.vary, {}, identities_of(options)};
  for (const auto& folder : folders) {
    const auto found = read_record(folder);
    const std::string why = found ? difference(*found, wanted) : "it holds none";
    if (!why.empty()) throw UsageError(fmt::format("--merge: {} holds another evaluation: {}", folder.string(), why));
  }
  for (const auto& folder : folders) {
    const fs::path runs = folder / "runs";
    if (!fs::exists(runs) || fs::equivalent(folder, request.folder)) continue;
    for (const auto& variant : fs::directory_iterator(runs)) {
      for (const auto& run : fs::directory_iterator(variant.path())) {
        if (!fs::exists(run.path() / "outcome.json")) continue;  // not over
        const fs::path to = request.folder / "runs" / variant.path().filename() / run.path().filename();
        if (fs::exists(to / "outcome.json")) continue;
        fs::remove_all(to);
        fs::create_directories(to.parent_path());
        const fs::path beside = to.string() + ".part";  // renamed when it is complete
        fs::remove_all(beside);
        fs::copy(run.path(), beside, fs::copy_options::recursive);
        fs::rename(beside, to);
      }
    }
  }
}

}  // namespace constrictor::cli
