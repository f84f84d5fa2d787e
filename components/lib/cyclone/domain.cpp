#include "cyclone/domain.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>

#include "constrictor/text.hpp"
#include "cyclone/abort_place.hpp"
#include "cyclone/create_domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/security.hpp"

namespace constrictor::dds {
namespace {

// Message size and participant index: see deploy/README.md. What Cyclone logs goes to LimitedLog; its trace, which
// would repeat the lines without a limit, goes nowhere.
constexpr const char* kLoopback = R"(<CycloneDDS><Domain>
<General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast><MaxMessageSize>65500B</MaxMessageSize></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>119</MaxAutoParticipantIndex>
<Peers><Peer Address="127.0.0.1"/></Peers></Discovery>)";
constexpr const char* kTracing =
    "<Tracing><Verbosity>severe</Verbosity><OutputFile>/dev/null</OutputFile></Tracing></Domain></CycloneDDS>";

/// The configuration that the launcher of a run on several hosts has published for this domain, or the built-in one.
std::string configuration_of(std::uint32_t domain) {
  std::string published = published_dds_configuration(domain);
  return published.empty() ? loopback_configuration() : published;
}

/// Writes the lines that Cyclone DDS logs, at most kMostLines in each kInterval: packets from strangers can cause a
/// line each. The number of lines that were left out is written with the next line.
class LimitedLog {
 public:
  static void write(void* log, const dds_log_data_t* line) {
    static_cast<LimitedLog*>(log)->write(std::string(line->message, line->size));
  }

 private:
  static constexpr std::uint64_t kMostLines = 10;
  static constexpr std::chrono::seconds kInterval{10};

  void write(const std::string& text) {
    const std::lock_guard lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    if (now - since_ > kInterval) {
      since_ = now;
      lines_ = 0;
    }
    if (++lines_ > kMostLines) {
      ++left_out_;
      return;
    }
    if (left_out_ > 0)
      std::fprintf(stderr, "Cyclone DDS: %llu more lines\n", static_cast<unsigned long long>(left_out_));
    left_out_ = 0;
    std::string line = printable(text.substr(0, text.find_last_not_of('\n') + 1));
    std::fprintf(stderr, "Cyclone DDS: %s\n", line.c_str());
  }

  std::mutex mutex_;
  std::chrono::steady_clock::time_point since_{};
  std::uint64_t lines_ = 0;
  std::uint64_t left_out_ = 0;
};

void limit_log_of_dds() {
  static LimitedLog* const log = new LimitedLog;  // DDS may write until the process ends
  dds_set_log_sink(&LimitedLog::write, log);
}

}  // namespace

std::string internal_settings(int heartbeat_ms) {
  return "<Internal><Watermarks><WhcHigh>64MB</WhcHigh></Watermarks><MaxSampleSize>64MB</MaxSampleSize>"
         "<NackDelay>5ms</NackDelay><AutoReschedNackDelay>100ms</AutoReschedNackDelay>"
         "<HeartbeatInterval min=\"2ms\" minsched=\"5ms\" max=\"500ms\">" +
         std::to_string(heartbeat_ms) + "ms</HeartbeatInterval></Internal>";
}

std::string loopback_configuration() {
  return std::string(kLoopback) + internal_settings(kLoopbackHeartbeat_ms) + kTracing;
}

Entity create_participant(std::uint32_t domain, Reach reach, const std::string& identity) {
  const Qos qos = make_qos();
  const auto folder = reach == Reach::kLoopback ? security_folder(domain) : std::filesystem::path();
  if (!folder.empty()) {
    const char* chosen = std::getenv("CONSTRICTOR_IDENTITY");
    set_identity(qos.get(), folder, !identity.empty() ? identity : chosen && *chosen ? chosen : "operator");
  }
  return {dds_create_participant(domain, qos.get(), nullptr), "dds_create_participant"};
}

Entity create_domain(std::uint32_t domain, Reach reach, const std::string& settings) {
  limit_log_of_dds();
  say_where_aborted();
  const char* chosen = std::getenv("CYCLONEDDS_URI");
  if (reach == Reach::kNetwork || (chosen && settings.empty())) return {};
  std::string configuration = chosen ? chosen : configuration_of(domain);
  if (!settings.empty()) configuration += "," + settings;  // Cyclone DDS reads one part after the other
  return {dds_create_domain(domain, configuration.c_str()), "dds_create_domain"};
}

Domain::Domain(std::uint32_t domain, Reach reach, const std::string& identity)
    : domain_(create_domain(domain, reach)), participant_(create_participant(domain, reach, identity)) {}

}  // namespace constrictor::dds
