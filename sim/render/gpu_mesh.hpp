// Meshes in OpenGL's buffers. A mesh is drawn once for each of its instances.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>

#include "sim/render/gl_handles.hpp"
#include "sim/render/meshes.hpp"
#include "sim/render/scene.hpp"

namespace constrictor {

/// Attributes of one instance of a solid, in the layout of the vertex shader.
struct Instance {
  std::array<float, 12> rows;  // 3x4 row-major X_WInstance
  std::array<float, 3> scale;
  std::array<float, 4> colour;  // reflectance, gloss
};

/// `scale` stretches the mesh in its own frame; `gloss` (0 to 1) is the strength of its highlights.
Instance make_instance(const Eigen::Isometry3d& X_W, const Eigen::Vector3d& scale, const Rgb& colour, double gloss);

/// A mesh in OpenGL's buffers, with its instances.
struct GpuMesh {
  GlVertexArray array;
  GlBuffer vertices;
  GlBuffer indices;
  GlBuffer instances;
  GLsizei index_count = 0;
  GLsizei instance_count = 0;
};

/// upload and set_instances need a current context.
GpuMesh upload(const Mesh& mesh, bool instanced);
void set_instances(GpuMesh& mesh, std::span<const Instance> instances);

}  // namespace constrictor
