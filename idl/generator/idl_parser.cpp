#include "idl/generator/idl_parser.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <stdexcept>

namespace constrictor::generator {
namespace {

struct Token {
  std::string text;
  int line = 0;
};

/// The tokens of a file, and its `//` comments by line.
struct Lexed {
  std::vector<Token> tokens;
  std::map<int, std::string> comments;
  std::map<int, bool> code_on_line;
};

std::string trim(const std::string& text) {
  const auto first = text.find_first_not_of(" \t/");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

Lexed lex(const std::string& text) {
  Lexed lexed;
  int line = 1;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '\n') {
      ++line;
      ++i;
    } else if (std::isspace(static_cast<unsigned char>(c))) {
      ++i;
    } else if (c == '#' || text.compare(i, 2, "//") == 0) {
      const std::size_t end = std::min(text.find('\n', i), text.size());
      if (c != '#') lexed.comments[line] = trim(text.substr(i, end - i));
      i = end;
    } else {
      std::size_t end = i + 1;
      const auto word = [&](char x) { return std::isalnum(static_cast<unsigned char>(x)) || x == '_' || x == '.'; };
      if (word(c) || c == '-') {
        while (end < text.size() && word(text[end])) ++end;
      }
      lexed.tokens.push_back({text.substr(i, end - i), line});
      lexed.code_on_line[line] = true;
      i = end;
    }
  }
  return lexed;
}

class Parser {
 public:
  Parser(std::string path, Lexed lexed, Model& model)
      : path_(std::move(path)), lexed_(std::move(lexed)), model_(model) {}

  void run() {
    while (at_ < lexed_.tokens.size()) {
      const std::string word = next();
      if (word == "module") {
        next();
        expect("{");
      } else if (word == "}") {
        if (peek() == ";") next();
      } else if (word == "const") {
        constant();
      } else if (word == "@") {
        if (next() != "final") fail("annotation; only @final stands before a struct");
      } else if (word == "struct") {
        structure();
      } else {
        fail("'" + word + "'; accepted: module, const, @final struct");
      }
    }
  }

 private:
  [[noreturn]] void fail(const std::string& found) const {
    const int line = lexed_.tokens[std::min(at_ > 0 ? at_ - 1 : 0, lexed_.tokens.size() - 1)].line;
    throw std::runtime_error(path_ + ":" + std::to_string(line) + ": found " + found);
  }
  [[nodiscard]] std::string peek() const { return at_ < lexed_.tokens.size() ? lexed_.tokens[at_].text : ""; }
  std::string next() {
    if (at_ >= lexed_.tokens.size()) fail("the end of the file");
    return lexed_.tokens[at_++].text;
  }
  void expect(const std::string& text) {
    if (const std::string found = next(); found != text) fail("'" + found + "', accepted '" + text + "'");
  }
  [[nodiscard]] int line() const { return lexed_.tokens[at_ - 1].line; }
  [[nodiscard]] std::string file_name() const { return path_.substr(path_.find_last_of('/') + 1); }

  std::uint32_t number(const std::string& text) {
    for (const auto& known : model_.constants) {
      if (known.name == text) return known.value;
    }
    try {
      return static_cast<std::uint32_t>(std::stoul(text));
    } catch (const std::exception&) {
      fail("'" + text + "', accepted a number or a constant");
    }
  }

  void constant() {
    const std::string type = next();
    if (type != "long" && type != "octet") fail("const " + type + "; accepted: long, octet");
    Constant constant{next(), type == "long" ? "int" : "std::uint8_t", 0, file_name(), line()};
    expect("=");
    constant.value = number(next());
    expect(";");
    model_.constants.push_back(constant);
  }

  /// The comment lines directly above a line.
  [[nodiscard]] std::string comment_above(int line) const {
    std::string text;
    for (int above = line - 1; lexed_.comments.contains(above) && !lexed_.code_on_line.contains(above); --above) {
      text = lexed_.comments.at(above) + (text.empty() ? "" : " ") + text;
    }
    return text;
  }

  void structure() {
    Struct parsed;
    parsed.comment = comment_above(line());
    parsed.file = file_name();
    parsed.name = next();
    expect("{");
    while (peek() != "}") parsed.fields.push_back(field());
    next();
    expect(";");
    model_.structs.push_back(std::move(parsed));
  }

  void annotations(Field& field) {
    while (peek() == "@") {
      next();
      const std::string name = next();
      if (name == "key") {
        field.is_key = true;
      } else if (name == "range") {
        expect("(");
        expect("min");
        expect("=");
        field.min = next();
        expect(",");
        expect("max");
        expect("=");
        field.max = next();
        expect(")");
        field.has_range = true;
      } else {
        fail("@" + name + "; accepted: @key, @range(min=, max=)");
      }
    }
  }

  std::string integer_type() {
    std::string word = next();
    const bool is_unsigned = word == "unsigned";
    if (is_unsigned) word = next();
    if (word == "short") return is_unsigned ? "std::uint16_t" : "std::int16_t";
    if (word == "long") {
      const bool twice = peek() == "long";
      if (twice) next();
      return std::string(is_unsigned ? "std::uint" : "std::int") + (twice ? "64_t" : "32_t");
    }
    fail("type '" + word + "'");
  }

  void type(Field& field) {
    const std::string word = peek();
    if (word == "unsigned" || word == "short" || word == "long") {
      field.type = integer_type();
      return;
    }
    next();
    if (word == "octet") {
      field.type = "std::uint8_t";
    } else if (word == "boolean") {
      field.type = "bool";
    } else if (word == "double" || word == "float") {
      field.type = word;
    } else if (word == "string") {
      expect("<");
      field.string_bound = number(next());
      expect(">");
      field.type = "char";
    } else if (word == "sequence") {
      expect("<");
      expect("octet");
      expect(">");
      field.is_sequence = true;
      field.type = "std::uint8_t";
    } else {
      const bool known =
          std::any_of(model_.structs.begin(), model_.structs.end(), [&](const Struct& s) { return s.name == word; });
      if (!known) fail("type '" + word + "', which is not defined before");
      field.is_struct = true;
      field.type = word;
    }
  }

  Field field() {
    Field parsed;
    parsed.comment = comment_above(lexed_.tokens[at_].line);
    annotations(parsed);
    type(parsed);
    parsed.name = next();
    if (parsed.name.front() == '_') parsed.name.erase(0, 1);  // IDL's escape for a name that is one of its keywords
    if (peek() == "[") {
      next();
      parsed.array_length = number(next());
      expect("]");
    }
    expect(";");
    const auto behind = lexed_.comments.find(line());
    if (behind != lexed_.comments.end()) parsed.comment += (parsed.comment.empty() ? "" : " ") + behind->second;
    return parsed;
  }

  std::string path_;
  Lexed lexed_;
  Model& model_;
  std::size_t at_ = 0;
};

}  // namespace

void parse_idl(const std::string& path, const std::string& text, Model& model) { Parser(path, lex(text), model).run(); }

}  // namespace constrictor::generator
