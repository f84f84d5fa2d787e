// constrictor_describe OUTPUT FILE.idl...: writes the header that gives every message its C++ name and a description of its
// fields, from which validation, hashing, comparison, JSON and the tools derive.
#include <openssl/sha.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "idl_parser.hpp"

namespace {

using namespace constrictor::describe;

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

/// The `[unit]` at a comment's start.
std::string unit_of(const std::string& comment) {
  if (comment.empty() || comment[0] != '[') return {};
  return comment.substr(1, comment.find(']') - 1);
}

void write_struct(std::ostream& out, const Struct& s) {
  out << "template <>\nstruct Description<msg::" << s.name << "> {\n"
      << "  static constexpr const char* kName = " << quoted(s.name) << ";\n"
      << "  static constexpr const char* kFile = " << quoted(s.file) << ";\n"
      << "  static constexpr const char* kDoc = " << quoted(s.comment) << ";\n";
  for (const auto& f : s.fields) {
    out << "  static constexpr FieldInfo k_" << f.name << "{" << quoted(f.name) << ", " << quoted(unit_of(f.comment)) << ", "
        << quoted(f.comment) << ", " << (f.has_range ? "true, " + f.min + ", " + f.max : "false, 0, 0") << ", "
        << (f.comment.find("NaN") != std::string::npos ? "true" : "false") << ", " << (f.is_key ? "true" : "false") << "};\n";
  }
  out << "  /// Calls visitor(FieldInfo, field) for each field in order.\n"
      << "  template <class Message, class Visitor>\n  static void visit(Message& message, Visitor&& visitor) {\n";
  for (const auto& f : s.fields) out << "    visitor(k_" << f.name << ", message." << f.name << ");\n";
  out << "  }\n};\n\n";
}

std::string hash_of(const std::string& bytes) {
  unsigned char digest[SHA256_DIGEST_LENGTH];
  SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), digest);
  std::string hex;
  for (const unsigned char byte : digest) {
    char pair[3];
    std::snprintf(pair, sizeof(pair), "%02x", byte);
    hex += pair;
  }
  return hex;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: constrictor_describe OUTPUT.hpp FILE.idl...\n";
    return 64;
  }
  try {
    Model model;
    std::string all;
    std::ostringstream out;
    out << "// Made by constrictor_describe from the IDL files. Do not edit.\n#pragma once\n\n#include <cstdint>\n#include <string_view>\n\n";
    for (int i = 2; i < argc; ++i) {
      const std::string text = read(argv[i]);
      parse_idl(argv[i], text, model);
      all += text;
      out << "#include \"" << std::filesystem::path(argv[i]).stem().string() << ".h\"\n";
    }
    out << "\nnamespace constrictor::msg {\n\n";
    for (const auto& c : model.constants) out << "inline constexpr " << c.type << " " << c.name << " = " << c.value << ";\n";
    out << "\n";
    for (const auto& s : model.structs) out << "using " << s.name << " = ::constrictor_msg_" << s.name << ";  ///< " << s.comment << "\n";
    out << "\n/// SHA-256 of the IDL files: processes with different ones do not talk.\n"
        << "inline constexpr std::string_view kIdlHash = \"" << hash_of(all) << "\";\n\n}  // namespace constrictor::msg\n\n"
        << "namespace constrictor {\n\n"
        << "/// What the IDL says of one field.\nstruct FieldInfo {\n  const char* name;\n  const char* unit;  ///< without brackets; may be empty\n"
        << "  const char* doc;\n  bool has_range;\n  double min;\n  double max;\n  bool nan_allowed;  ///< NaN means \"unknown\" here\n  bool is_key;\n};\n\n"
        << "/// Name, documentation and fields of a message type.\ntemplate <class Message>\nstruct Description;\n\n";
    for (const auto& s : model.structs) write_struct(out, s);
    out << "template <class... Messages>\nstruct TypeList {};\n/// Every struct of the IDL files, in order.\nusing AllMessages = TypeList<";
    for (std::size_t i = 0; i < model.structs.size(); ++i) out << (i ? ", " : "") << "msg::" << model.structs[i].name;
    out << ">;\n\n";
    out << "}  // namespace constrictor\n";
    std::filesystem::create_directories(std::filesystem::path(argv[1]).parent_path());
    std::ofstream file(argv[1], std::ios::binary);
    file << out.str();
    if (!file.flush()) throw std::runtime_error(std::string(argv[1]) + ": cannot be written");
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
