// How long samples take from their writer to a viewer of the dashboard, alone and beside viewers that read nothing.
// scripts/bench_dashboard.sh starts it beside a run of the case study.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "integration/dashboard_viewer.hpp"

namespace {

using constrictor::testing::Viewer;
using Clock = std::chrono::steady_clock;

/// Subscribes to these topics; to all that are advertised if there are none. Returns the number of subscriptions.
std::uint32_t subscribe(Viewer& viewer, const std::set<std::string>& topics) {
  std::vector<std::uint32_t> channels;
  // What the dashboard knows comes first; then nothing comes, because nothing has been subscribed to yet.
  while (const auto message = viewer.receive(std::chrono::milliseconds(500))) {
    if (!message->text) continue;
    const auto text = nlohmann::json::parse(message->bytes, nullptr, false);
    if (text.value("op", "") != "advertise") continue;
    for (const auto& channel : text.at("channels"))
      if (topics.empty() || topics.contains(channel.at("topic"))) channels.push_back(channel.at("id"));
  }
  std::uint32_t count = 0;
  for (const std::uint32_t channel : channels) viewer.send_text(Viewer::subscribe(++count, channel));
  return count;
}

/// [MiB] memory of a process that is in RAM.
double memory_mib(const std::string& pid) {
  std::ifstream status("/proc/" + pid + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024;
  return 0;
}

struct Measured {
  std::vector<double> latencies_ms;
  std::vector<double> memory_mib;  // once a second
};

/// Reads for some seconds. The time in a frame is that at which the writer wrote the sample, of the clock of this host.
Measured watch(Viewer& viewer, const std::string& pid, int seconds) {
  Measured measured;
  const auto now_ns = [] {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  const std::int64_t begin_ns = now_ns();
  const auto end = Clock::now() + std::chrono::seconds(seconds);
  for (auto sample = Clock::now(); Clock::now() < end;) {
    if (Clock::now() >= sample) {
      measured.memory_mib.push_back(memory_mib(pid));
      sample += std::chrono::seconds(1);
    }
    const auto message = viewer.receive(std::chrono::seconds(2));
    if (!message) break;
    if (message->text || message->bytes.size() < 13) continue;
    std::uint64_t written_ns = 0;
    for (int i = 7; i >= 0; --i)
      written_ns = written_ns << 8 | static_cast<std::uint8_t>(message->bytes[static_cast<std::size_t>(5 + i)]);
    if (static_cast<std::int64_t>(written_ns) < begin_ns) continue;  // it waited because no client read
    measured.latencies_ms.push_back(static_cast<double>(now_ns() - static_cast<std::int64_t>(written_ns)) * 1e-6);
  }
  return measured;
}

void print(const char* what, Measured measured) {
  auto& all = measured.latencies_ms;
  auto& memory = measured.memory_mib;
  if (all.empty() || memory.empty()) {
    std::printf("%s: nothing arrived\n", what);
    std::exit(EXIT_FAILURE);
  }
  std::sort(all.begin(), all.end());
  const auto at = [&](double share) {
    return all[std::min(all.size() - 1, static_cast<std::size_t>(share * static_cast<double>(all.size())))];
  };
  std::printf(
      "%s: %zu samples, latency p50 %.2f ms, p99 %.2f ms, most %.2f ms; memory of the dashboard %.0f MiB at the "
      "begin, %.0f at half time, %.0f at the end, at most %.0f\n",
      what, all.size(), at(0.5), at(0.99), all.back(), memory.front(), memory[memory.size() / 2], memory.back(),
      *std::max_element(memory.begin(), memory.end()));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: bench_dashboard PORT PID SECONDS\n");
    return 64;
  }
  const auto port = static_cast<std::uint16_t>(std::atoi(argv[1]));
  const std::string pid = argv[2];
  const int seconds = std::atoi(argv[3]);
  Viewer live(port);
  if (subscribe(live, {"joint_state"}) != 1) {
    std::fprintf(stderr, "bench_dashboard: no topic joint_state at port %s\n", argv[1]);
    return EXIT_FAILURE;
  }
  print("one viewer", watch(live, pid, seconds));
  std::deque<Viewer> stalled;
  std::uint32_t topics = 0;
  for (int i = 0; i < 3; ++i) topics = subscribe(stalled.emplace_back(port), {});
  std::printf("three more viewers subscribe to %u topics each, images included, and read nothing from now on\n",
              topics);
  print("one viewer beside three stalled ones", watch(live, pid, 2 * seconds));
  return EXIT_SUCCESS;
}
