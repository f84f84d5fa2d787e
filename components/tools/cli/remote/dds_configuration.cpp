#include "cli/remote/dds_configuration.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "configuration/configuration.hpp"
#include "cyclone/domain.hpp"

namespace constrictor::cli {

std::string dds_configuration(const std::string& own, const std::vector<std::string>& others, int message_bytes,
                              const std::string& additional) {
  std::string peers = fmt::format("<Peer Address=\"{}\"/>", own);
  for (const auto& address : others) peers += fmt::format("<Peer Address=\"{}\"/>", address);
  const std::string configuration = fmt::format(
      "<CycloneDDS><Domain><General><Interfaces>"
      "<NetworkInterface address=\"{}\" multicast=\"false\"/>"
      "</Interfaces><AllowMulticast>false</AllowMulticast><MaxMessageSize>{}B</MaxMessageSize></General>"
      "<Discovery><SPDPInterval>2s</SPDPInterval><ParticipantIndex>auto</ParticipantIndex>"
      "<MaxAutoParticipantIndex>119</MaxAutoParticipantIndex>"
      "<Peers>{}</Peers></Discovery>{}"
      "<Tracing><Verbosity>severe</Verbosity><OutputFile>/dev/null</OutputFile></Tracing></Domain></CycloneDDS>",
      own, message_bytes, peers, dds::internal_settings(dds::kNetworkHeartbeat_ms));
  return additional.empty() ? configuration : configuration + "," + additional;
}

std::string resolve_dds_uri(const std::string& uri) {
  std::string xml;
  std::size_t at = 0;
  while (at < uri.size()) {
    if (uri[at] == ',' || std::isspace(static_cast<unsigned char>(uri[at])) != 0) {
      ++at;
      continue;
    }
    if (uri[at] == '<') {  // XML until the end; a file cannot follow it, because commas may be part of XML
      xml += (xml.empty() ? "" : ",") + uri.substr(at);
      break;
    }
    const auto comma = uri.find(',', at);
    std::string path = uri.substr(at, comma == std::string::npos ? comma : comma - at);
    at = comma == std::string::npos ? uri.size() : comma + 1;
    if (path.starts_with("file://")) path = path.substr(7);
    std::ifstream file(path);
    if (!file)
      throw ConfigurationError("CYCLONEDDS_URI: found " + path + ", which cannot be read; accepted XML or a file");
    std::string text(std::istreambuf_iterator<char>(file), {});
    text.erase(0, text.find("<CycloneDDS"));  // a comment before the root element is not accepted inside of a list
    xml += (xml.empty() ? "" : ",") + text;
  }
  return xml;
}

}  // namespace constrictor::cli
