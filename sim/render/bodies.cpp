#include "sim/render/bodies.hpp"

#include <algorithm>
#include <cstdint>

namespace constrictor {
namespace {

Eigen::Vector3d vertex(const Mesh& mesh, std::size_t index) {
  return Eigen::Vector3f(&mesh.vertices[index * Mesh::kFloatsPerVertex]).cast<double>();
}

}  // namespace

void Solids::build(const Mesh& mesh) {
  mesh_ = upload(mesh, true);
  half_extent_.setZero();
  for (std::size_t i = 0; i < mesh.vertices.size() / Mesh::kFloatsPerVertex; ++i) {
    half_extent_ = half_extent_.cwiseMax(vertex(mesh, i).cwiseAbs());
  }
}

void Solids::add(const Eigen::Isometry3d& X_W, const Eigen::Vector3d& scale, const Rgb& colour, double gloss) {
  placed_.push_back(
      {make_instance(X_W, scale, colour, gloss), X_W.translation(), half_extent_.cwiseProduct(scale).norm()});
}

bool Solids::choose(const Needed& needed) {
  chosen_.clear();
  for (const Placed& body : placed_) {
    if (needed(body.centre, body.radius_m)) chosen_.push_back(body.instance);
  }
  if (chosen_.empty()) mesh_.instance_count = 0;
  else set_instances(mesh_, chosen_);
  return !chosen_.empty();
}

void Solids::draw() const {
  if (mesh_.instance_count == 0) return;
  glBindVertexArray(mesh_.array.get());
  glDrawElementsInstanced(GL_TRIANGLES, mesh_.index_count, GL_UNSIGNED_INT, nullptr, mesh_.instance_count);
}

Flat::Flat(const Mesh& mesh, const Rgb& colour, float pattern_strength)
    : mesh_(upload(mesh, false)), colour_(colour), pattern_strength_(pattern_strength) {
  constexpr std::size_t kPieceIndices = 3 * 32;
  for (std::size_t first = 0; first < mesh.indices.size(); first += kPieceIndices) {
    const std::size_t end = std::min(first + kPieceIndices, mesh.indices.size());
    Eigen::AlignedBox3d box;
    for (std::size_t i = first; i < end; ++i) box.extend(vertex(mesh, mesh.indices[i]));
    pieces_.push_back(
        {static_cast<GLsizei>(first), static_cast<GLsizei>(end - first), box.center(), 0.5 * box.diagonal().norm()});
  }
}

void Flat::draw(const Needed& needed) const {
  glBindVertexArray(mesh_.array.get());
  for (std::size_t i = 0; i < pieces_.size();) {
    // Neighbours that are both needed are drawn with one call.
    const GLsizei first = pieces_[i].first_index;
    GLsizei count = 0;
    for (; i < pieces_.size() && needed(pieces_[i].centre, pieces_[i].radius_m); ++i) count += pieces_[i].index_count;
    if (count == 0) {
      ++i;
      continue;
    }
    glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT,
                   // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL expects the offset as a pointer
                   reinterpret_cast<const void*>(static_cast<std::size_t>(first) * sizeof(std::uint32_t)));
  }
}

}  // namespace constrictor
