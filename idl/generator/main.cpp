// constrictor_describe FOLDER FILE.idl...: writes two headers into FOLDER.
//   messages.hpp     C++ names of messages and constants, and descriptions from which validation, hashing, comparison,
//                    JSON and the tools are derived
//   descriptors.hpp  the DDS topic descriptor of each message, for code that makes DDS readers and writers
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "constrictor/hex.hpp"
#include "constrictor/sha256.hpp"
#include "idl/generator/constant_groups.hpp"
#include "idl/generator/idl_parser.hpp"

namespace {

using namespace constrictor::generator;
namespace fs = std::filesystem;

constexpr const char* kMade = "// Made by constrictor_describe from the IDL files. Do not edit.\n#pragma once\n\n";

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error(path.string() + ": cannot be written");
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

/// The range of a field: as @range says, else the values of its group of constants.
std::string range_of(const Field& field, const ConstantGroup* group) {
  if (field.has_range) return "true, " + field.min + ", " + field.max;
  if (group) return "true, 0, " + std::to_string(group->names.size() - 1);
  return "false, 0, 0";
}

void write_groups(std::ostream& out, const std::vector<ConstantGroup>& groups) {
  out << "namespace constrictor::msg {\n\n";
  for (const auto& group : groups) {
    out << "inline constexpr std::uint8_t " << group.prefix << "Count = " << group.names.size() << ";\n";
  }
  out << "\n}  // namespace constrictor::msg\n\nnamespace constrictor::constants {\n\n";
  for (const auto& group : groups) {
    out << "inline constexpr const char* " << group.prefix << "Names[] = {";
    for (const auto& name : group.names) out << quoted(name) << ", ";
    out << "};\ninline constexpr ConstantGroup " << group.prefix << "{" << quoted(group.prefix) << ", " << group.prefix
        << "Names};\n";
  }
  out << "\n/// Every group.\ninline constexpr const ConstantGroup* kAll[] = {";
  for (const auto& group : groups) out << "&" << group.prefix << ", ";
  out << "};\n\n}  // namespace constrictor::constants\n\n";
}

void write_struct(std::ostream& out, const Struct& s, const std::vector<ConstantGroup>& groups) {
  out << "template <>\nstruct Description<msg::" << s.name << "> {\n"
      << "  static constexpr const char* kName = " << quoted(s.name) << ";\n"
      << "  static constexpr const char* kFile = " << quoted(s.file) << ";\n"
      << "  static constexpr const char* kDoc = " << quoted(s.comment) << ";\n";
  for (const auto& f : s.fields) {
    const ConstantGroup* group = nullptr;
    for (const auto& each : groups) {
      if (each.prefix == group_of(f)) group = &each;
    }
    out << "  static constexpr FieldInfo k_" << f.name << "{" << quoted(f.name) << ", " << quoted(unit_of(f.comment))
        << ", " << quoted(f.comment) << ", " << range_of(f, group) << ", "
        << (f.comment.find("NaN") != std::string::npos ? "true" : "false") << ", " << (f.is_key ? "true" : "false")
        << ", " << (group ? "&constants::" + group->prefix : "nullptr") << "};\n";
  }
  out << "  /// Calls visitor(FieldInfo, field) for each field in order.\n"
      << "  template <class Message, class Visitor>\n  static void visit(Message& message, Visitor&& visitor) {\n";
  for (const auto& f : s.fields) out << "    visitor(k_" << f.name << ", message." << f.name << ");\n";
  out << "  }\n};\n\n";
}

std::string messages_header(const Model& model, const std::vector<std::string>& files, const std::string& hash) {
  const std::vector<ConstantGroup> groups = constant_groups(model);
  std::ostringstream out;
  out << kMade << "#include <cstdint>\n#include <string_view>\n\n#include \"constrictor/description.hpp\"\n";
  for (const auto& file : files) out << "#include \"" << fs::path(file).stem().string() << ".h\"\n";
  out << "\nnamespace constrictor::msg {\n\n";
  for (const auto& c : model.constants) {
    out << "inline constexpr " << c.type << " " << c.name << " = " << c.value << ";\n";
  }
  out << "\n";
  for (const auto& s : model.structs) {
    out << "using " << s.name << " = ::constrictor_msg_" << s.name << ";  ///< " << s.comment << "\n";
  }
  out << "\n/// SHA-256 of the IDL files: processes of one run have the same.\n"
      << "inline constexpr std::string_view kIdlHash = " << quoted(hash) << ";\n\n}  // namespace constrictor::msg\n\n";
  write_groups(out, groups);
  out << "namespace constrictor {\n\n";
  for (const auto& s : model.structs) write_struct(out, s, groups);
  out << "/// Every struct of the IDL files, in order.\nusing AllMessages = TypeList<";
  for (std::size_t i = 0; i < model.structs.size(); ++i) out << (i ? ", " : "") << "msg::" << model.structs[i].name;
  out << ">;\n\n}  // namespace constrictor\n";
  return out.str();
}

std::string descriptors_header(const Model& model) {
  std::ostringstream out;
  out << kMade << "#include \"constrictor/messages.hpp\"\n\nnamespace constrictor::dds {\n\n"
      << "/// The DDS topic descriptor that idlc made for a message type.\n"
      << "template <class Message>\nconst dds_topic_descriptor_t& descriptor();\n\n";
  for (const auto& s : model.structs) {
    out << "template <>\ninline const dds_topic_descriptor_t& descriptor<msg::" << s.name
        << ">() {\n  return constrictor_msg_" << s.name << "_desc;\n}\n";
  }
  out << "\n}  // namespace constrictor::dds\n";
  return out.str();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: constrictor_describe FOLDER FILE.idl...\n";
    return 64;
  }
  try {
    const fs::path folder = argv[1];
    const std::vector<std::string> files(argv + 2, argv + argc);
    Model model;
    std::string all;
    for (const auto& file : files) {
      const std::string text = read(file);
      parse_idl(file, text, model);
      all += text;
    }
    const std::string hash = constrictor::hex(constrictor::sha256(std::as_bytes(std::span(all))));
    write(folder / "messages.hpp", messages_header(model, files, hash));
    write(folder / "descriptors.hpp", descriptors_header(model));
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
