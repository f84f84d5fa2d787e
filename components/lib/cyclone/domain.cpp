#include "cyclone/domain.hpp"

#include <cstdlib>
#include <string>

#include "cyclone/domain_claim.hpp"

namespace constrictor::dds {
namespace {

// Message size and participant index: see deploy/README.md.
constexpr const char* kLoopback = R"(<CycloneDDS><Domain>
<General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
<AllowMulticast>false</AllowMulticast><MaxMessageSize>65500B</MaxMessageSize></General>
<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>119</MaxAutoParticipantIndex>
<Peers><Peer Address="localhost"/></Peers></Discovery>
<Tracing><Verbosity>severe</Verbosity><OutputFile>stderr</OutputFile></Tracing>
)";

/// The configuration that the launcher of a run on several hosts has published for this domain, or the built-in one.
std::string configuration_of(std::uint32_t domain) {
  std::string published = published_dds_configuration(domain);
  return published.empty() ? std::string(kLoopback) + kInternalSettings + "</Domain></CycloneDDS>" : published;
}

}  // namespace

Domain::Domain(std::uint32_t domain, Reach reach) {
  if (reach == Reach::kLoopback && !std::getenv("CYCLONEDDS_URI"))
    domain_ = Entity(dds_create_domain(domain, configuration_of(domain).c_str()), "dds_create_domain");
  participant_ = Entity(dds_create_participant(domain, nullptr, nullptr), "dds_create_participant");
}

}  // namespace constrictor::dds
