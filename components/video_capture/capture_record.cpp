#include "video_capture/capture_record.hpp"

#include <nlohmann/json.hpp>

namespace constrictor {

void CaptureRecord::write(std::int64_t tick, std::uint64_t published, std::uint64_t late,
                          const video::LiveCounters& counters) {
  replace([&] {
    return nlohmann::json{{"tick", tick},
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
                          {"failures", counters.failures}};
  });
}

}  // namespace constrictor
