// The type of a topic as text in the language of ROS 2's message files, which viewers of recordings read. Source:
// https://mcap.dev/spec/registry#ros2msg
#include <fmt/format.h>

#include <cctype>
#include <set>
#include <stdexcept>

#include "cyclone/type_node.hpp"
#include "cyclone/type_tree.hpp"

namespace constrictor::dds {
namespace {

using Kind = TypeNode::Kind;

/// The type cannot be expressed; what() says why.
class NotExpressible : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct RosName {
  std::string package;
  std::string type;
};

/// "constrictor::msg::Tick" is constrictor/Tick, "std_msgs::msg::dds_::String_" is std_msgs/String, "Plain" is
/// dds/Plain.
RosName ros_name(std::string name) {
  std::vector<std::string> parts;
  for (std::size_t end = name.find("::"); end != std::string::npos; end = name.find("::")) {
    parts.push_back(name.substr(0, end));
    name.erase(0, end + 2);
  }
  if (!parts.empty() && parts.back() == "dds_" && name.ends_with('_')) {
    parts.pop_back();
    name.pop_back();
  }
  if (parts.size() > 1 && parts.back() == "msg") parts.pop_back();
  return {parts.empty() ? "dds" : fmt::format("{}", fmt::join(parts, "_")), name};
}

/// The name of a number with this DDS_XTypes_TK_...
std::string primitive(std::uint8_t kind) {
  switch (kind) {
    case 1:
      return "bool";
    case 2:
    case 16:  // a character: the character type of ROS 2 is this number, too
      return "uint8";
    case 3:
      return "int16";
    case 4:
      return "int32";
    case 5:
      return "int64";
    case 6:
      return "uint16";
    case 7:
      return "uint32";
    case 8:
      return "uint64";
    case 9:
      return "float32";
    case 10:
      return "float64";
    default:
      throw NotExpressible(fmt::format("a number of kind {}", kind));
  }
}

/// A name as ROS 2 requires it: lower case, single underscores within it, a letter first. "X_HC" becomes "x_hc".
std::string field_name(const std::string& name) {
  std::string result;
  for (const char character : name) {
    const auto byte = static_cast<unsigned char>(character);
    if (std::isalnum(byte)) result += static_cast<char>(std::tolower(byte));
    else if (!result.empty() && result.back() != '_') result += '_';
  }
  while (result.ends_with('_')) result.pop_back();
  return result.empty() || std::isdigit(static_cast<unsigned char>(result.front())) ? "f" + result : result;
}

class Schema {
 public:
  explicit Schema(const TypeNode& root) {
    if (root.kind != Kind::kStruct) throw NotExpressible("a type that is no structure");
    write_structure(root, text_);
    // Structures that are found meanwhile are appended to the list.
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const RosName name = ros_name(parts_[i]->name);
      text_ += fmt::format("{}\nMSG: {}/{}\n", std::string(80, '='), name.package, name.type);
      write_structure(*parts_[i], text_);
    }
  }
  [[nodiscard]] std::string text() const { return text_; }

 private:
  void write_structure(const TypeNode& type, std::string& text) {
    if (type.extensibility == TypeNode::Extensibility::kMutable) throw NotExpressible("a mutable structure");
    std::set<std::string> names;
    for (const auto& member : type.members) {
      if (member.optional) throw NotExpressible("an optional member");
      std::string name = field_name(member.name);
      while (!names.insert(name).second) name += "2";  // two names that differ in letter case only
      text += fmt::format("{} {}\n", field_type(*member.type), name);
    }
  }
  std::string field_type(const TypeNode& type) {
    if (type.kind == Kind::kSequence) return element_type(*type.element) + "[]";
    if (type.kind != Kind::kArray) return element_type(type);
    std::uint64_t count = 1;
    const TypeNode* element = &type;
    for (; element->kind == Kind::kArray; element = element->element.get()) {
      for (const auto bound : element->bounds) count *= bound;
    }
    return fmt::format("{}[{}]", element_type(*element), count);
  }
  std::string element_type(const TypeNode& type) {
    switch (type.kind) {
      case Kind::kPrimitive:
      case Kind::kEnum:
      case Kind::kBitmask: {
        const bool is_enum = type.kind == Kind::kEnum && type.primitive == 4;
        return is_enum ? "uint32" : primitive(type.primitive);
      }
      case Kind::kString:
        return "string";
      case Kind::kStruct: {
        if (known_.insert(type.name).second) parts_.push_back(&type);
        const RosName name = ros_name(type.name);
        return name.package + "/" + name.type;
      }
      case Kind::kUnion:
        throw NotExpressible("a union");
      default:
        throw NotExpressible("a sequence in a collection");
    }
  }

  std::string text_;
  std::vector<const TypeNode*> parts_;
  std::set<std::string> known_;
};

}  // namespace

Ros2Schema TypeTree::ros2_schema() const {
  const RosName name = ros_name(root_->name);
  try {
    return {name.package + "/msg/" + name.type, Schema(*root_).text(), ""};
  } catch (const NotExpressible& why) {
    return {"", "", std::string("its type contains ") + why.what()};
  }
}

}  // namespace constrictor::dds
