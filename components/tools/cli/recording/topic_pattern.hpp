// Patterns of topic names: * stands for any characters, ? for one.
#pragma once

#include <algorithm>
#include <cctype>
#include <regex>
#include <string>
#include <vector>

namespace constrictor::cli {

class TopicPatterns {
 public:
  explicit TopicPatterns(const std::vector<std::string>& patterns) {
    for (const auto& pattern : patterns) patterns_.emplace_back(expression(pattern));
  }
  [[nodiscard]] bool empty() const { return patterns_.empty(); }
  [[nodiscard]] bool match(const std::string& topic) const {
    return std::any_of(patterns_.begin(), patterns_.end(),
                       [&](const std::regex& one) { return std::regex_match(topic, one); });
  }

 private:
  static std::string expression(const std::string& pattern) {
    std::string text;
    for (const char character : pattern) {
      const bool plain = std::isalnum(static_cast<unsigned char>(character)) || character == '_';
      if (character == '*') text += ".*";
      else if (character == '?') text += '.';
      else text += plain ? std::string(1, character) : std::string("\\") + character;
    }
    return text;
  }
  std::vector<std::regex> patterns_;
};

}  // namespace constrictor::cli
