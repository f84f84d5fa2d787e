// The size of a terminal, and text that is cut to it.
#pragma once

#include <cstddef>
#include <string>

namespace constrictor {

/// Size of a terminal in characters.
struct ScreenSize {
  std::size_t columns = 80;
  std::size_t rows = 24;
  bool operator==(const ScreenSize&) const = default;
};

/// Present size of the terminal at standard output; 80x24 if there is none, or if it does not report its size.
[[nodiscard]] ScreenSize screen_size();

/// `text` as one line of at most `columns` characters, without blanks at its end and with "?" for each byte that is not
/// printable ASCII. A line that was cut ends with ">".
[[nodiscard]] std::string screen_line(std::string text, std::size_t columns);

}  // namespace constrictor
