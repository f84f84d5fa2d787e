// Texts for people that are longer than the field of a message.
#pragma once

#include <string>

namespace constrictor {

/// The text, cut after a word and ended with " ..." if it has more than `bytes` bytes. `bytes` is at least 5.
[[nodiscard]] inline std::string shortened(const std::string& text, std::size_t bytes) {
  const std::string cut = " ...";
  if (text.size() <= bytes) return text;
  const std::size_t room = bytes - cut.size();
  const std::size_t end = text.rfind(' ', room);
  return text.substr(0, end == std::string::npos ? room : end) + cut;
}

}  // namespace constrictor
