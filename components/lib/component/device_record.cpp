#include "component/device_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "configuration/whole_file.hpp"
#include "constrictor/json.hpp"

namespace constrictor {
namespace {

constexpr std::size_t kMostNews = 50;

/// [ms] the value below which `share` of the sorted durations are.
double quantile_ms(const std::vector<std::int64_t>& sorted, double share) {
  const auto index = static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1));
  return static_cast<double>(sorted[index]) * 1e-6;
}

}  // namespace

DeviceRecord::DeviceRecord(const std::filesystem::path& folder, const char* file_name, std::string durations)
    : durations_(std::move(durations)) {
  if (!folder.empty()) file_ = folder / file_name;
}

void DeviceRecord::add_news(const std::string& line) {
  if (news_.size() == kMostNews) news_.erase(news_.begin());
  news_.push_back(line);
}

void DeviceRecord::replace(std::string state, const std::function<nlohmann::json()>& make_fields) {
  std::vector<std::int64_t> durations_ns = std::exchange(durations_ns_, {});
  std::sort(durations_ns.begin(), durations_ns.end());
  summary_ = std::move(state);
  if (!durations_ns.empty())
    summary_ += fmt::format(", {} {:.1f} ms (99 %: {:.1f})", durations_, quantile_ms(durations_ns, 0.5),
                            quantile_ms(durations_ns, 0.99));
  if (file_.empty()) return;
  nlohmann::json record = make_fields();
  record["news"] = news_;
  if (!durations_ns.empty()) {
    record[durations_ + "_ms"] = {{"median", quantile_ms(durations_ns, 0.5)},
                                  {"p99", quantile_ms(durations_ns, 0.99)},
                                  {"longest", quantile_ms(durations_ns, 1.0)}};
  }
  const std::string text = json_text(record, 1) + "\n";
  try {
    write_whole(file_, text);
  } catch (const std::runtime_error&) {
    // The folder is full or gone: the next write may succeed.
  }
}

}  // namespace constrictor
