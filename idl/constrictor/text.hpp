// Text in the bounded strings of messages.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>

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

}  // namespace constrictor
