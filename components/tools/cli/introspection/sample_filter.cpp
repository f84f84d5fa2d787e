#include "cli/introspection/sample_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "configuration/closest_name.hpp"
#include "constrictor/json.hpp"

namespace constrictor::cli {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::array kOperators = {"==", "!=", "<=", ">=", "<", ">"};  // the longer ones first
constexpr int kDeepest = 100;

struct Token {
  enum class Kind { kWord, kText, kNumber, kSign, kEnd } kind = Kind::kEnd;
  std::string text;
  std::size_t at = 0;
};

bool is_word(char character) {
  return std::isalnum(static_cast<unsigned char>(character)) || std::string_view("_.*:/-+").find(character) < 7;
}

std::optional<double> number_of(const std::string& text) {
  double value = 0.0;
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::vector<Token> tokens_of(const std::string& text) {
  std::vector<Token> tokens;
  for (std::size_t at = 0; at < text.size();) {
    const char first = text[at];
    if (std::isspace(static_cast<unsigned char>(first))) {
      ++at;
    } else if (first == '\'' || first == '"') {
      const auto end = text.find(first, at + 1);
      if (end == std::string::npos) throw FilterError(fmt::format("the quote at column {} has no end", at + 1));
      tokens.push_back({Token::Kind::kText, text.substr(at + 1, end - at - 1), at});
      at = end + 1;
    } else if (first == '(' || first == ')') {
      tokens.push_back({Token::Kind::kSign, std::string(1, first), at++});
    } else if (is_word(first)) {
      std::size_t end = at;
      while (end < text.size() && is_word(text[end])) ++end;
      const std::string word = text.substr(at, end - at);
      tokens.push_back({number_of(word) ? Token::Kind::kNumber : Token::Kind::kWord, word, at});
      at = end;
    } else {
      const auto found = std::find_if(kOperators.begin(), kOperators.end(),
                                      [&](const char* sign) { return text.compare(at, strlen(sign), sign) == 0; });
      if (found == kOperators.end())
        throw FilterError(
            fmt::format("found '{}' at column {}, accepted a field, a number, a text in quotes, ( ) == != "
                        "< <= > >= and or not",
                        first, at + 1));
      tokens.push_back({Token::Kind::kSign, *found, at});
      at += strlen(*found);
    }
  }
  tokens.push_back({Token::Kind::kEnd, "", text.size()});
  return tokens;
}

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts(1);
  for (const char character : path) {
    if (character == '.') parts.emplace_back();
    else parts.back() += character;
  }
  return parts;
}

/// Adds the values that a path names; `missing` is set to the text of an error if there is no such field.
void collect(const Json& value, const std::vector<std::string>& parts, std::size_t i, std::vector<Json>& found,
             std::string& missing) {
  if (i == parts.size()) {
    found.push_back(value);
    return;
  }
  const std::string& name = parts[i];
  if (value.is_array()) {
    const auto index = number_of(name);
    if (name == "*") {
      for (const Json& element : value) collect(element, parts, i + 1, found, missing);
    } else if (!index || *index < 0 || *index != std::floor(*index)) {
      missing = fmt::format("found '{}' after a list, accepted an index or *", name);
    } else if (*index < static_cast<double>(value.size())) {
      collect(value[static_cast<std::size_t>(*index)], parts, i + 1, found, missing);
    }
  } else if (value.is_object() && value.contains(name)) {
    collect(value[name], parts, i + 1, found, missing);
  } else if (!value.is_object()) {
    missing = fmt::format("found '{}' after a plain value, which has no parts", name);
  } else {
    std::vector<std::string> names;
    for (const auto& [key, ignored] : value.items()) names.push_back(key);
    missing = fmt::format("there is no field '{}'{}; accepted are {}", name, did_you_mean(name, names),
                          fmt::join(names, ", "));
  }
}

bool is_true(const Json& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number()) return value.get<double>() != 0.0;
  return value.is_string() ? !value.get_ref<const std::string&>().empty() : value.is_structured() && !value.empty();
}

bool compare(const Json& left, const std::string& sign, const Json& right) {
  const bool numbers = left.is_number() && right.is_number();
  const bool equal = numbers ? left.get<double>() == right.get<double>() : left == right;
  if (sign == "==") return equal;
  if (sign == "!=") return !equal;
  if (left.is_null() || right.is_null()) return false;  // NaN is neither smaller nor larger
  if (!numbers)
    throw FilterError(
        fmt::format("{} compares numbers only, found {} and {}", sign, json_text(left), json_text(right)));
  const double a = left.get<double>();
  const double b = right.get<double>();
  return sign == "<" ? a < b : sign == "<=" ? a <= b : sign == ">" ? a > b : a >= b;
}

}  // namespace

struct SampleFilter::Node {
  enum class Kind { kAnd, kOr, kNot, kCompare, kField, kValue } kind;
  std::string text;  ///< of a comparison: its sign; of a field: its path
  Json value;
  std::vector<std::unique_ptr<Node>> parts;

  [[nodiscard]] bool holds(const Json& sample) const {
    switch (kind) {
      case Kind::kAnd:
        return parts[0]->holds(sample) && parts[1]->holds(sample);
      case Kind::kOr:
        return parts[0]->holds(sample) || parts[1]->holds(sample);
      case Kind::kNot:
        return !parts[0]->holds(sample);
      case Kind::kCompare: {
        const auto left = parts[0]->values(sample, false);
        const bool texts = std::any_of(left.begin(), left.end(), [](const Json& one) { return one.is_string(); });
        const auto right = parts[1]->values(sample, texts || left.empty());
        return std::any_of(left.begin(), left.end(), [&](const Json& a) {
          return std::any_of(right.begin(), right.end(), [&](const Json& b) { return compare(a, text, b); });
        });
      }
      case Kind::kField:
      case Kind::kValue: {
        const auto all = values(sample, false);
        return std::any_of(all.begin(), all.end(), is_true);
      }
    }
    return false;
  }
  /// `may_be_text`: a word that names no field stands for itself, as the names of constants do.
  [[nodiscard]] std::vector<Json> values(const Json& sample, bool may_be_text) const {
    if (kind == Kind::kValue) return {value};
    std::vector<Json> found;
    std::string missing;
    collect(sample, parts_of(text), 0, found, missing);
    if (found.empty() && !missing.empty()) {
      if (may_be_text && text.find('.') == std::string::npos) return {Json(text)};
      throw FilterError(missing);
    }
    return found;
  }
};

namespace {

using Node = SampleFilter::Node;
using NodePtr = std::unique_ptr<Node>;

class Parser {
 public:
  explicit Parser(const std::string& text) : tokens_(tokens_of(text)) {}
  NodePtr whole() {
    NodePtr made = either();
    if (now().kind != Token::Kind::kEnd) unexpected("and, or, a comparison, or the end");
    return made;
  }

 private:
  [[nodiscard]] const Token& now() const { return tokens_[at_]; }
  [[nodiscard]] bool is(Token::Kind kind, const char* text) const { return now().kind == kind && now().text == text; }
  bool take(Token::Kind kind, const char* text) {
    if (!is(kind, text)) return false;
    ++at_;
    return true;
  }
  [[noreturn]] void unexpected(const char* accepted) const {
    const bool end = now().kind == Token::Kind::kEnd;
    throw FilterError(fmt::format("found {} at column {}, accepted {}",
                                  end ? "the end" : fmt::format("'{}'", now().text), now().at + 1, accepted));
  }
  static NodePtr node(Node::Kind kind, std::string text, NodePtr a, NodePtr b = nullptr) {
    auto made = std::make_unique<Node>(Node{kind, std::move(text), {}, {}});
    made->parts.push_back(std::move(a));
    if (b) made->parts.push_back(std::move(b));
    return made;
  }
  NodePtr either() {
    NodePtr made = both();
    while (take(Token::Kind::kWord, "or")) made = node(Node::Kind::kOr, "", std::move(made), both());
    return made;
  }
  NodePtr both() {
    NodePtr made = single();
    while (take(Token::Kind::kWord, "and")) made = node(Node::Kind::kAnd, "", std::move(made), single());
    return made;
  }
  NodePtr single() {
    if (++depth_ > kDeepest) throw FilterError(fmt::format("more than {} nested \"not\" and parentheses", kDeepest));
    NodePtr made;
    if (take(Token::Kind::kWord, "not")) {
      made = node(Node::Kind::kNot, "", single());
    } else if (take(Token::Kind::kSign, "(")) {
      made = either();
      if (!take(Token::Kind::kSign, ")")) unexpected(")");
    } else {
      made = operand();
      const bool compares = now().kind == Token::Kind::kSign && now().text != "(" && now().text != ")";
      if (compares) {
        const std::string sign = tokens_[at_++].text;
        made = node(Node::Kind::kCompare, sign, std::move(made), operand());
      }
    }
    --depth_;
    return made;
  }
  NodePtr operand() {
    const Token token = now();
    const auto value = [&](Json json) {
      ++at_;
      return std::make_unique<Node>(Node{Node::Kind::kValue, "", std::move(json), {}});
    };
    if (token.kind == Token::Kind::kNumber) return value(*number_of(token.text));
    if (token.kind == Token::Kind::kText) return value(token.text);
    if (token.kind != Token::Kind::kWord || token.text == "and" || token.text == "or" || token.text == "not")
      unexpected("a field, a number or a text");
    if (token.text == "true" || token.text == "false") return value(token.text == "true");
    if (token.text == "null" || token.text == "nan") return value(nullptr);
    ++at_;
    return std::make_unique<Node>(Node{Node::Kind::kField, token.text, {}, {}});
  }

  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

SampleFilter::SampleFilter(const std::string& expression) : root_(Parser(expression).whole()) {}
SampleFilter::~SampleFilter() = default;
bool SampleFilter::accepts(const Json& sample) const { return root_->holds(sample); }

}  // namespace constrictor::cli
