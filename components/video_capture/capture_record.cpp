#include "video_capture/capture_record.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

namespace constrictor {
namespace {

constexpr std::size_t kMostNews = 50;

}  // namespace

CaptureRecord::CaptureRecord(const std::filesystem::path& folder) {
  if (!folder.empty()) file_ = folder / "camera.json";
}

void CaptureRecord::add_news(const std::string& line) {
  if (news_.size() == kMostNews) news_.erase(news_.begin());
  news_.push_back(line);
}

void CaptureRecord::write(std::int64_t tick, std::uint64_t published, std::uint64_t late,
                          const video::LiveCounters& counters) {
  std::vector<std::int64_t> ages_ns = std::exchange(ages_ns_, {});
  if (file_.empty()) return;
  nlohmann::json record = {{"tick", tick},
                           {"source", counters.description},
                           {"connected", counters.connected},
                           {"frozen", counters.frozen},
                           {"black", counters.black},
                           {"rate_hz", counters.rate_hz},
                           {"published", published},
                           {"late", late},
                           {"frames", counters.frames},
                           {"stale", counters.stale},
                           {"overtaken", counters.overtaken},
                           {"missing", counters.missing},
                           {"openings", counters.openings},
                           {"failures", counters.failures},
                           {"news", news_}};
  if (!ages_ns.empty()) {
    std::sort(ages_ns.begin(), ages_ns.end());
    const auto quantile_ms = [&](double share) {
      return static_cast<double>(ages_ns[static_cast<std::size_t>(share * static_cast<double>(ages_ns.size() - 1))]) *
             1e-6;
    };
    record["age_ms"] = {{"median", quantile_ms(0.5)}, {"p99", quantile_ms(0.99)}, {"longest", quantile_ms(1.0)}};
  }
  std::filesystem::path next = file_;
  next += ".new";
  std::ofstream stream(next, std::ios::trunc);
  stream << record.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
  stream.close();
  std::error_code ignored;
  if (stream) std::filesystem::rename(next, file_, ignored);
}

}  // namespace constrictor
