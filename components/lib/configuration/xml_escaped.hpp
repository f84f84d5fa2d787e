// Text inside XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace constrictor {

/// The text, for the content of an element or for an attribute in double quotes. Control characters, most of which XML
/// forbids, become spaces.
inline std::string xml_escaped(std::string_view text) {
  std::string xml;
  for (const char c : text) {
    if (c == '&') xml += "&amp;";
    else if (c == '<') xml += "&lt;";
    else if (c == '>') xml += "&gt;";
    else if (c == '"') xml += "&quot;";
    else xml += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return xml;
}

}  // namespace constrictor
