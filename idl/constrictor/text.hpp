// Text in the bounded strings of messages.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

namespace constrictor {

/// Copies text into a bounded string of a message, cut to what fits.
template <std::size_t N>
void set_text(char (&field)[N], const std::string& text) {
  const std::size_t length = std::min(text.size(), N - 1);
  std::copy_n(text.begin(), length, field);
  std::fill(field + length, field + N, '\0');
}

/// The text of such a string, which need not end with a zero.
template <std::size_t N>
std::string text_of(const char (&field)[N]) {
  return {field, ::strnlen(field, N)};
}

/// Text that came over the network, for a terminal or a log: each control character (C0, DEL, C1) and each byte that is
/// not UTF-8 becomes "?", so that no message can control a terminal. `kept`: control characters that stay.
std::string printable(std::string text, std::string_view kept = {});

}  // namespace constrictor
