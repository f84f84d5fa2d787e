// Key moments of a run and their pictures. They become the rows of the figure.
#pragma once

#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "sim/report/raw_images.hpp"

namespace constrictor::report {

class LostFiles;

/// Images whose exposures are farther apart show something else.
inline constexpr std::int64_t kSameMoment_ticks = 50;

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

/// The newest messages at a moment; null: there is none.
struct Newest {
  const msg::CameraImage* camera = nullptr;
  const msg::CameraImage* processed = nullptr;
  const msg::WorldState* world = nullptr;
};

/// Saves raw image and world state of each moment at once. Perception draws only some of the images: when the first
/// processed image arrives that was not exposed before the raw one, it is saved, and the raw image of its exposure
/// takes the place of the first. The picture of the scene is drawn after the end of the run (draw_scene_pictures()).
///
/// The images of a moment always have the same exposure, at most kSameMoment_ticks from the raw image that was the
/// newest one at the moment. If there is no such pair, the moment keeps the raw image alone.
///
/// Images given to this class must have the right number of bytes (image_violation()). A picture that cannot be written
/// is noted in `lost` and not tried again.
struct MomentAlbum {
  std::vector<Moment> moments;
  RawImages raws;                   ///< the one of the newest processed image, and newer ones while they may be needed
  bool processed_are_late = false;  ///< a processed image came when there was a newer raw image

  /// Moments after the first 100 are ignored, so that the state stays small. A picture of the scene that an earlier run
  /// left for this tick is removed.
  void add(Moment moment, const std::filesystem::path& folder, const Newest& newest, LostFiles& lost);
  /// To be called for each raw image, before the processed image that came at the same tick.
  void on_camera(const std::filesystem::path& folder, const msg::CameraImage& image, LostFiles& lost);
  /// To be called for each processed image. `camera`: the newest raw image; null: there is none.
  void on_processed(const std::filesystem::path& folder, const msg::CameraImage& image, const msg::CameraImage* camera,
                    LostFiles& lost);
  /// Saves the newest processed image, with its raw image, for the moments that still have none, because no further
  /// images arrive after the end of the run. A moment without a raw image gets the processed one alone.
  void finish(const std::filesystem::path& folder, const msg::CameraImage& processed, LostFiles& lost);

  template <class Archive>
  void serialize(Archive& archive) {
    archive(moments, raws, processed_are_late);
  }
};

}  // namespace constrictor::report
