#include "common/screen_size.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

namespace constrictor {

ScreenSize screen_size() {
  winsize window{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) != 0 || window.ws_col == 0 || window.ws_row == 0) return {};
  return {window.ws_col, window.ws_row};
}

std::string screen_line(std::string text, std::size_t columns) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  text.erase(text.find_last_not_of(' ') + 1);
  if (text.size() <= columns) return text;
  text.resize(columns);
  if (!text.empty()) text.back() = '>';
  return text;
}

}  // namespace constrictor
