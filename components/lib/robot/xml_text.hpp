// Writes XML line by line, for the descriptions of the robot in the formats of other programs.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <string>
#include <utility>

namespace constrictor {

class XmlText {
 public:
  /// Adds a line, indented by `depth` steps. Numbers are written so that they are read back unchanged.
  template <class... Arguments>
  void line(std::size_t depth, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    text_.append(2 * depth, ' ');
    fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
    text_ += '\n';
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

}  // namespace constrictor
