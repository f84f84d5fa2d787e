// The pictures of the scene at the key moments. During a run only the world state of each moment is saved, because all
// members wait while the report draws. The pictures are drawn when the run ends.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <vector>

#include "constrictor/messages.hpp"
#include "sim/report/moments.hpp"

namespace constrictor::report {

/// Writes a file with a world state and its SHA-256. The file is replaced as a whole, and equal world states give equal
/// files. Throws NotWritten.
void save_world(const std::filesystem::path& file, const msg::WorldState& world);

/// Reads a file that save_world() wrote. Null if the file is missing or damaged.
[[nodiscard]] std::shared_ptr<const msg::WorldState> read_world(const std::filesystem::path& file);

/// Draws the picture of the scene (OverviewView with its default options) for each moment whose world state can be read
/// and writes it into the snapshots of `folder`. A moment without a readable world state keeps the picture that it has:
/// none, or the one that this process drew before it was killed and restarted. `head_camera_m`: [m] p_HC. A
/// picture that cannot be written is noted in `lost`. Throws std::runtime_error if OpenGL fails, or if the
/// module that draws is missing.
void draw_scene_pictures(const std::filesystem::path& folder, const std::vector<Moment>& moments,
                         const msg::SceneDescription& scene, const Eigen::Vector3d& head_camera_m, LostFiles& lost);

/// Removes all world states and raw images (RawImages) from the snapshots of `folder`, also those of an earlier epoch
/// or run.
void remove_work_files(const std::filesystem::path& folder);

}  // namespace constrictor::report
