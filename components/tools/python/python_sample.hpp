// Samples as Python objects: dictionaries, lists, texts, numbers and NumPy arrays.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>

#include "cyclone/type_tree.hpp"

namespace constrictor::python {

struct SampleForm {
  bool names = true;   ///< constants of this project's types as their names: "blue", not 3
  bool whole = false;  ///< arrays with all elements, also those that their ..._count does not count
};

/// Decodes a sample to a dictionary. Arrays and sequences of numbers become NumPy arrays of their type, and the pixels
/// of a CameraImage one of height x width x 3. Needs the GIL. Throws std::runtime_error if the bytes do not fit `type`.
pybind11::object to_python(const dds::TypeTree& type, std::span<const std::uint8_t> bytes, const SampleForm& form);

/// JSON as Python objects.
pybind11::object to_python(const nlohmann::ordered_json& json);

/// Python objects as JSON, NumPy arrays included; bytes and arrays of uint8 become binary values, NaN becomes null.
/// Throws std::invalid_argument that names the place of an object that messages cannot hold.
nlohmann::ordered_json to_json(const pybind11::handle& object, const std::string& path = "");

}  // namespace constrictor::python
