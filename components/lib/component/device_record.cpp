#include "component/device_record.hpp"

#include <fmt/format.h>

#include <utility>

#include "configuration/quantiles.hpp"
#include "configuration/whole_file.hpp"
#include "constrictor/json.hpp"

namespace constrictor {
namespace {

constexpr std::size_t kMostNews = 50;

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
  std::vector<double> durations_ms;
  for (const std::int64_t ns : std::exchange(durations_ns_, {})) durations_ms.push_back(static_cast<double>(ns) * 1e-6);
  summary_ = std::move(state);
  if (!durations_ms.empty())
    summary_ += fmt::format(", {} {:.1f} ms (99 %: {:.1f})", durations_, lower_quantile(durations_ms, 0.5),
                            lower_quantile(durations_ms, 0.99));
  if (file_.empty()) return;
  nlohmann::json record = make_fields();
  record["news"] = news_;
  if (!durations_ms.empty()) {
    record[durations_ + "_ms"] = {{"median", lower_quantile(durations_ms, 0.5)},
                                  {"p99", lower_quantile(durations_ms, 0.99)},
                                  {"longest", lower_quantile(durations_ms, 1.0)}};
  }
  const std::string text = json_text(record, 1) + "\n";
  try {
    write_whole(file_, text);
  } catch (const std::runtime_error&) {
    // The folder is full or gone: the next write may succeed.
  }
}

}  // namespace constrictor
