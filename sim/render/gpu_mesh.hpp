// Meshes on OpenGL's side, drawn once for each of their instances.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>

#include "sim/render/gl_handles.hpp"
#include "sim/render/meshes.hpp"
#include "sim/render/scene.hpp"

namespace constrictor {

/// Per-instance attributes of a solid.
struct Instance {
  std::array<float, 12> rows;  // 3x4 row-major X_WInstance
  std::array<float, 3> scale;
  std::array<float, 4> colour;  // reflectance, gloss
};

/// `scale` stretches the mesh in its own frame; `gloss` is the strength of its highlights.
Instance make_instance(const Eigen::Isometry3d& X_W, const Eigen::Vector3d& scale, const Rgb& colour, double gloss);

/// A mesh on the GPU side, with room for instances.
struct GpuMesh {
  GlVertexArray array;
  GlBuffer vertices;
  GlBuffer indices;
  GlBuffer instances;
  GLsizei index_count = 0;
  GLsizei instance_count = 0;
};

/// This and the next need a current context.
GpuMesh upload(const Mesh& mesh, bool instanced);
void set_instances(GpuMesh& mesh, std::span<const Instance> instances);

}  // namespace constrictor
