#include "python/python_sample.hpp"

#include <pybind11/numpy.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "constrictor/constants.hpp"
#include "constrictor/field_table.hpp"
#include "cyclone/primitives.hpp"
#include "cyclone/sample_visitor.hpp"

namespace constrictor::python {
namespace {

namespace py = pybind11;
using Json = nlohmann::ordered_json;
using namespace dds::primitives;

/// `kind`: of a number.
py::dtype dtype_of(std::uint8_t kind) {
  return with_number_type(
      kind, []<class T>(T) { return py::dtype::of<T>(); }, [] { return py::dtype::of<double>(); });
}

/// Builds the Python object of a sample while it is decoded.
class Builder : public dds::SampleVisitor {
 public:
  explicit Builder(const SampleForm& form) : form_(form) {}
  [[nodiscard]] py::object take() { return std::move(root_); }

  void boolean(bool value) override { add(py::bool_(value)); }
  void whole(std::int64_t value) override { add(py::int_(value)); }
  void natural(std::uint64_t value) override {
    if (skips()) return;
    if (Open& open = open_.back(); open.fields) open.counts[open.at] = value;
    const FieldEntry* field = entry();
    const bool named = form_.names && field && field->info.constants && value < field->info.constants->names.size();
    if (named) add(py::str(name_of(*field->info.constants, static_cast<std::uint8_t>(value))));
    else add(py::int_(value));
  }
  void real(double value) override { add(py::float_(value)); }
  void text(std::string value) override {
    // The token of a run lets its reader command the run, so it must not remain in notebooks and logs.
    const FieldEntry* field = entry();
    if (field && std::string_view(field->info.name) == "token" && !value.empty()) value = "(hidden)";
    add(py::reinterpret_steal<py::object>(
        PyUnicode_DecodeUTF8(value.data(), static_cast<Py_ssize_t>(value.size()), "replace")));
  }
  void absent() override { add(py::none()); }
  void numbers(const dds::NumberArray& values) override {
    if (skips()) return;
    std::vector<py::ssize_t> shape(values.dimensions.begin(), values.dimensions.end());
    shape.front() = static_cast<py::ssize_t>(std::min(static_cast<std::size_t>(shape.front()), used()));
    const FieldEntry* field = entry();
    if (form_.names && field && field->info.constants && values.primitive == kByte) {
      py::list names;
      for (std::size_t i = 0; i < static_cast<std::size_t>(shape.front()); ++i)
        names.append(name_of(*field->info.constants, values.bytes[i]));
      return add(names);
    }
    add(py::array(dtype_of(values.primitive), std::move(shape), values.bytes.data()));
  }
  void begin_list(std::uint32_t) override {
    if (skip_begins()) return;
    const std::size_t most = used();
    open({py::list(), nullptr, 0, most, {}, false});
  }
  void end_list() override { close(); }
  void begin_struct(const dds::TypeNode& type) override {
    if (skip_begins()) return;
    const auto* fields = fields_of(type.name);
    open({py::dict(), fields, static_cast<std::size_t>(-1), 0, std::vector<std::uint64_t>(fields ? fields->size() : 0),
          type.name == "constrictor::msg::CameraImage"});
  }
  void member(const std::string& name) override {
    if (skipped_ > 0) return;
    ++open_.back().at;
    name_ = py::str(name);
  }
  void end_struct() override {
    if (skipped_ == 0 && open_.back().image) shape_image(open_.back());
    close();
  }

 private:
  struct Open {
    py::object object;
    const std::vector<FieldEntry>* fields;  ///< of a structure of this project
    std::size_t at;                         ///< the member of a structure
    std::size_t most;                       ///< of a list: number of elements to keep
    std::vector<std::uint64_t> counts;      ///< the numbers in a structure, by field
    bool image;
  };

  /// The field of this project to which the next value belongs; of a list, that of the list itself.
  [[nodiscard]] const FieldEntry* entry() const {
    for (auto open = open_.rbegin(); open != open_.rend(); ++open) {
      if (py::isinstance<py::list>(open->object)) continue;
      return open->fields && open->at < open->fields->size() ? &(*open->fields)[open->at] : nullptr;
    }
    return nullptr;
  }
  /// How many elements of the list that begins now are used.
  [[nodiscard]] std::size_t used() const {
    const FieldEntry* field = entry();
    const bool counted = !form_.whole && field && field->count_at >= 0 && !open_.empty() && open_.back().fields;
    return counted ? open_.back().counts[static_cast<std::size_t>(field->count_at)] : static_cast<std::size_t>(-1);
  }
  [[nodiscard]] bool skips() const {
    if (skipped_ > 0) return true;
    if (open_.empty() || !py::isinstance<py::list>(open_.back().object)) return false;
    return py::len(open_.back().object) >= open_.back().most;
  }
  bool skip_begins() {
    if (!skips()) return false;
    ++skipped_;
    return true;
  }
  void add(const py::object& value) {
    if (!skips()) put(value);
  }
  void put(const py::object& value) {
    if (open_.empty()) root_ = value;
    else if (PyDict_Check(open_.back().object.ptr())) {
      if (PyDict_SetItem(open_.back().object.ptr(), name_.ptr(), value.ptr()) != 0) throw py::error_already_set();
    } else if (PyList_Append(open_.back().object.ptr(), value.ptr()) != 0) {
      throw py::error_already_set();
    }
  }
  void open(Open made) {
    put(made.object);
    open_.push_back(std::move(made));
  }
  void close() {
    if (skipped_ > 0) --skipped_;
    else open_.pop_back();
  }
  static void shape_image(Open& image) {
    const auto dict = py::reinterpret_borrow<py::dict>(image.object);
    const auto pixels = py::reinterpret_borrow<py::array>(dict["data"]);
    const auto height = dict["height"].cast<py::ssize_t>();
    const auto width = dict["width"].cast<py::ssize_t>();
    // Otherwise the image is of another program, and its pixels stay a row of numbers.
    if (pixels.size() == height * width * 3) dict["data"] = pixels.attr("reshape")(height, width, 3);
  }

  SampleForm form_;
  py::object root_ = py::none();
  py::object name_;
  std::vector<Open> open_;
  int skipped_ = 0;  ///< depth below an element that is left out
};

}  // namespace

py::object to_python(const dds::TypeTree& type, std::span<const std::uint8_t> bytes, const SampleForm& form) {
  Builder builder(form);
  type.decode(bytes, builder);
  return builder.take();
}

py::object to_python(const Json& json) {
  switch (json.type()) {
    case Json::value_t::object: {
      py::dict made;
      for (const auto& [key, value] : json.items()) made[py::str(key)] = to_python(value);
      return made;
    }
    case Json::value_t::array: {
      py::list made;
      for (const auto& value : json) made.append(to_python(value));
      return made;
    }
    case Json::value_t::string:
      return py::str(json.get_ref<const std::string&>());
    case Json::value_t::boolean:
      return py::bool_(json.get<bool>());
    case Json::value_t::number_integer:
      return py::int_(json.get<std::int64_t>());
    case Json::value_t::number_unsigned:
      return py::int_(json.get<std::uint64_t>());
    case Json::value_t::number_float:
      return py::float_(json.get<double>());
    default:
      return py::none();
  }
}

Json to_json(const py::handle& object, const std::string& path) {
  const auto wrong = [&] {
    throw std::invalid_argument((path.empty() ? "message" : path) + ": found an object of type " +
                                std::string(py::str(py::type::handle_of(object).attr("__name__"))) +
                                ", accepted dictionaries, lists, arrays, texts, numbers, booleans and None");
  };
  if (object.is_none()) return nullptr;
  if (py::isinstance<py::bool_>(object)) return object.cast<bool>();
  if (py::isinstance<py::str>(object)) return object.cast<std::string>();
  if (py::isinstance<py::float_>(object)) {
    const double value = object.cast<double>();
    return std::isnan(value) ? Json(nullptr) : Json(value);
  }
  if (py::isinstance<py::int_>(object)) {
    int overflow = 0;
    const long long value = PyLong_AsLongLongAndOverflow(object.ptr(), &overflow);
    if (overflow == 0) return value;
    if (overflow < 0) wrong();
    const auto natural = PyLong_AsUnsignedLongLong(object.ptr());
    if (PyErr_Occurred()) {
      PyErr_Clear();
      wrong();
    }
    return natural;
  }
  if (py::isinstance<py::bytes>(object)) {
    const auto text = object.cast<std::string>();
    return Json::binary({text.begin(), text.end()});
  }
  if (py::isinstance<py::dict>(object)) {
    Json made = Json::object();
    for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(object)) {
      const std::string name = py::str(key);
      made[name] = to_json(value, path.empty() ? name : path + "." + name);
    }
    return made;
  }
  if (py::isinstance<py::array>(object)) {
    const auto array = py::reinterpret_borrow<py::array>(object);
    if (array.dtype().kind() == 'u' && array.itemsize() == 1) return to_json(array.attr("tobytes")(), path);
    return to_json(array.attr("tolist")(), path);
  }
  if (py::isinstance<py::list>(object) || py::isinstance<py::tuple>(object)) {
    Json made = Json::array();
    for (const auto& value : py::reinterpret_borrow<py::sequence>(object))
      made.push_back(to_json(value, path + "[" + std::to_string(made.size()) + "]"));
    return made;
  }
  if (py::hasattr(object, "item")) return to_json(object.attr("item")(), path);  // a number of NumPy
  wrong();
  return nullptr;
}

}  // namespace constrictor::python
