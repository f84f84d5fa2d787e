#include "cyclone/domain.hpp"

#include <cstdlib>

namespace constrictor::dds {
namespace {

// Message size and participant index: see deploy/README.md. The high-water mark prevents that a writer of images
// waits for a reader whose process is stopped; keep-last bounds the histories.
constexpr const char* kLoopback = R"(<CycloneDDS><Domain>
<General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast><MaxMessageSize>65500B</MaxMessageSize></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>119</MaxAutoParticipantIndex>
<Peers><Peer Address="localhost"/></Peers></Discovery>
<Internal><Watermarks><WhcHigh>64MB</WhcHigh></Watermarks></Internal>
<Tracing><Verbosity>severe</Verbosity><OutputFile>stderr</OutputFile></Tracing>
</Domain></CycloneDDS>)";

}  // namespace

Domain::Domain(std::uint32_t domain, Reach reach) {
  if (reach == Reach::kLoopback && !std::getenv("CYCLONEDDS_URI")) {
    domain_ = Entity(dds_create_domain(domain, kLoopback), "dds_create_domain");
  }
  participant_ = Entity(dds_create_participant(domain, nullptr, nullptr), "dds_create_participant");
}

}  // namespace constrictor::dds
