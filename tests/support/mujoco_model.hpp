// Compiles a MuJoCo model from text. Only programs that link mujoco::mujoco can include this file.
#pragma once

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <array>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>

#include "support/temporary_folder.hpp"

namespace constrictor::testing {

struct DeleteMujoco {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using MujocoModel = std::unique_ptr<mjModel, DeleteMujoco>;
using MujocoData = std::unique_ptr<mjData, DeleteMujoco>;

/// Throws std::runtime_error with MuJoCo's message if the text is not a correct model.
inline MujocoModel compile_mujoco_model(const std::string& xml) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "model.xml";
  std::ofstream(file) << xml;
  std::array<char, 1000> error{};
  MujocoModel model(mj_loadXML(file.c_str(), nullptr, error.data(), static_cast<int>(error.size())));
  if (!model) throw std::runtime_error(fmt::format("MuJoCo: {}", error.data()));
  return model;
}

}  // namespace constrictor::testing
