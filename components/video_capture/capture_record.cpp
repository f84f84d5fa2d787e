#include "video_capture/capture_record.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace constrictor {

void CaptureRecord::write(std::int64_t tick, std::uint64_t published, std::uint64_t late,
                          const video::LiveCounters& counters) {
  const char* state = !counters.connected ? "no connection"
                      : counters.frozen   ? "frozen"
                      : counters.black    ? "black"
                                          : "live";
  replace(fmt::format("{}, {:.1f} frames/s, {} missing, {} late, {} failures", state, counters.rate_hz,
                      counters.missing, late, counters.failures),
          [&] {
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
