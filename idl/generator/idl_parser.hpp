// Reads the subset of IDL that Constrictor's messages use, with the comments.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace constrictor::generator {

struct Field {
  std::string name;
  std::string type;                ///< C++ type of one element; the name of the struct for nested ones
  std::uint32_t array_length = 0;  ///< 0: not an array
  std::uint32_t string_bound = 0;  ///< > 0: a bounded string
  bool is_sequence = false;        ///< sequence<octet>
  bool is_struct = false;
  bool is_key = false;
  bool has_range = false;
  std::string min, max;  ///< as written in @range
  std::string comment;   ///< the comment lines above the field, then the comment behind it
};

struct Struct {
  std::string name;
  std::string comment;
  std::string file;
  std::vector<Field> fields;
};

struct Constant {
  std::string name;
  std::string type;  ///< "int" or "std::uint8_t"
  std::uint32_t value = 0;
  std::string file;
  int line = 0;
};

/// Everything that the files define, in their order.
struct Model {
  std::vector<Constant> constants;
  std::vector<Struct> structs;
};

/// Adds a file to `model`. Throws std::runtime_error with file and line if the text is not in the subset.
void parse_idl(const std::string& path, const std::string& text, Model& model);

}  // namespace constrictor::generator
