// Key moments of a run and their pictures. They become the rows of the figure.
#pragma once

#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor::report {

class LostFiles;

struct Moment {
  std::int64_t tick = 0;
  double time_s = 0.0;
  std::uint8_t event = msg::kEventNone;  ///< kEventNone: the end of the mission or of the run
  std::uint8_t colour = msg::kColourUnknown;
  std::string state;                  ///< state of the planner
  std::int64_t camera_exposure = -1;  ///< [tick] at which the raw image was exposed; -1: there is no image
  bool has_processed = false;
  bool ends = false;  ///< set by merge_end(): the mission or the run ended just after it

  template <class Archive>
  void serialize(Archive& archive) {
    archive(tick, time_s, event, colour, state, camera_exposure, has_processed);
  }
};

/// Files of a moment: its pictures, and the world state from which the picture of the scene is drawn. Their names
/// contain the tick: a process that repeats the tick after a restart writes the same files again, with the same
/// content.
struct MomentFiles {
  static constexpr const char* kFolder = "snapshots";  ///< within the output folder
  static constexpr const char* kWorld = "_world.bin";  ///< end of the names of world states
  std::filesystem::path scene, camera, processed, world;
  MomentFiles(const std::filesystem::path& folder, const Moment& moment);
};

/// Whether the event gets a row in the figure.
[[nodiscard]] bool is_key_event(std::uint8_t event);

/// Chooses the moments that become rows of the figure, in order of time. If the line or the same colour of object was
/// found several times, the first moment is chosen. If a recovery repeated pregrasped, grasped or dropped, the last one
/// is chosen.
[[nodiscard]] std::vector<Moment> figure_rows(const std::vector<Moment>& moments);

/// The rows without an end of the mission or of the run that came less than 2 s after the row before, because it would
/// show the same pictures again. That row `ends`.
[[nodiscard]] std::vector<Moment> merge_end(std::vector<Moment> rows);

/// Saves the raw image and the world state of each moment at once, and the processed image of the same exposure when it
/// arrives. The picture of the scene is drawn after the end of the run (draw_scene_pictures()).
struct MomentAlbum {
  std::vector<Moment> moments;

  /// Images given to this class must have the right number of bytes (image_violation()). `camera` and `world` may be
  /// null. Moments after the first 100 are ignored, so that the state stays small. A picture of the scene that an
  /// earlier run left for this tick is removed. A picture that cannot be written is noted in `lost` and not tried
  /// again.
  void add(Moment moment, const std::filesystem::path& folder, const msg::CameraImage* camera,
           const msg::WorldState* world, LostFiles& lost);
  void on_processed(const std::filesystem::path& folder, const msg::CameraImage& image, LostFiles& lost);
  /// Saves the newest processed image for all moments that still have none, because no further images arrive after the
  /// end of the run.
  void finish(const std::filesystem::path& folder, const msg::CameraImage& processed, LostFiles& lost);

  template <class Archive>
  void serialize(Archive& archive) {
    archive(moments);
  }
};

}  // namespace constrictor::report
