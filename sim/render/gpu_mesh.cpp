#include "sim/render/gpu_mesh.hpp"

#include <cstdint>

namespace constrictor {

Instance make_instance(const Eigen::Isometry3d& X_W, const Eigen::Vector3d& scale, const Rgb& colour, double gloss) {
  Instance instance{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      instance.rows[static_cast<std::size_t>(4 * row + column)] = static_cast<float>(X_W(row, column));
    }
    instance.scale[static_cast<std::size_t>(row)] = static_cast<float>(scale[row]);
  }
  instance.colour = {colour.r, colour.g, colour.b, static_cast<float>(gloss)};
  return instance;
}

GpuMesh upload(const Mesh& mesh, bool instanced) {
  GpuMesh gpu{GlVertexArray::create(), GlBuffer::create(), GlBuffer::create(), {}, 0, 0};
  gpu.index_count = static_cast<GLsizei>(mesh.indices.size());
  glBindVertexArray(gpu.array.get());
  glBindBuffer(GL_ARRAY_BUFFER, gpu.vertices.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.vertices.size() * sizeof(float)), mesh.vertices.data(),
               GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, gpu.indices.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)),
               mesh.indices.data(), GL_STATIC_DRAW);
  const auto attribute = [](GLuint location, GLint count, std::size_t stride_floats, std::size_t offset_floats,
                            GLuint divisor) {
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, count, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride_floats * sizeof(float)),
                          // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL expects the offset as a pointer
                          reinterpret_cast<const void*>(offset_floats * sizeof(float)));
    glVertexAttribDivisor(location, divisor);
  };
  attribute(0, 3, Mesh::kFloatsPerVertex, 0, 0);
  attribute(1, 3, Mesh::kFloatsPerVertex, 3, 0);
  attribute(2, 1, Mesh::kFloatsPerVertex, 6, 0);
  if (instanced) {
    gpu.instances = GlBuffer::create();
    glBindBuffer(GL_ARRAY_BUFFER, gpu.instances.get());
    constexpr std::size_t kStride = sizeof(Instance) / sizeof(float);
    for (GLuint row = 0; row < 3; ++row) attribute(3 + row, 4, kStride, 4 * row, 1);
    attribute(6, 3, kStride, 12, 1);
    attribute(7, 4, kStride, 15, 1);
  }
  glBindVertexArray(0);
  return gpu;
}

void set_instances(GpuMesh& mesh, std::span<const Instance> instances) {
  mesh.instance_count = static_cast<GLsizei>(instances.size());
  glBindBuffer(GL_ARRAY_BUFFER, mesh.instances.get());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances.size_bytes()), instances.data(), GL_STREAM_DRAW);
}

}  // namespace constrictor
