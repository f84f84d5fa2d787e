// The bodies that the renderer draws: solid bodies, which are placed anew for each frame, and flat surfaces on the
// ground. Parts that cannot change the image are left out.
#pragma once

#include <functional>
#include <vector>

#include "sim/render/gpu_mesh.hpp"

namespace constrictor {

/// Whether a body inside of a sphere must be drawn. `centre` in W.
using Needed = std::function<bool(const Eigen::Vector3d& centre, double radius_m)>;

/// All bodies with one mesh. All functions but clear() and add() need a current context.
class Solids {
 public:
  void build(const Mesh& mesh);
  void clear() { placed_.clear(); }
  /// `scale` stretches the mesh in its own frame; `gloss` (0 to 1) is the strength of its highlights.
  void add(const Eigen::Isometry3d& X_W, const Eigen::Vector3d& scale, const Rgb& colour, double gloss);
  /// Chooses the bodies for the next draw(), in the order in which they were added. Returns whether there is one.
  bool choose(const Needed& needed);
  void draw() const;

 private:
  struct Placed {
    Instance instance;
    Eigen::Vector3d centre;
    double radius_m;
  };
  GpuMesh mesh_;
  Eigen::Vector3d half_extent_ = Eigen::Vector3d::Zero();  // of the mesh's vertices, before it is stretched
  std::vector<Placed> placed_;
  std::vector<Instance> chosen_;
};

/// A coloured flat surface on z = 0.
class Flat {
 public:
  /// Needs a current context.
  Flat(const Mesh& mesh, const Rgb& colour, float pattern_strength);
  /// Draws the pieces of the surface that are needed. Needs a current context.
  void draw(const Needed& needed) const;
  [[nodiscard]] const Rgb& colour() const { return colour_; }
  [[nodiscard]] float pattern_strength() const { return pattern_strength_; }

 private:
  /// Successive triangles.
  struct Piece {
    GLsizei first_index, index_count;
    Eigen::Vector3d centre;
    double radius_m;
  };
  GpuMesh mesh_;
  Rgb colour_;
  float pattern_strength_;
  std::vector<Piece> pieces_;
};

}  // namespace constrictor
