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

struct Moment {
  std::int64_t tick = 0;
  double time_s = 0.0;
  std::uint8_t event = msg::kEventNone;  ///< kEventNone: the end of the mission or of the run
  std::uint8_t colour = msg::kColourUnknown;
  std::string state;                  ///< state of the planner
  std::int64_t camera_exposure = -1;  ///< [tick] at which the raw image was exposed; -1: there is no image
  bool has_processed = false;
  bool has_scene = false;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(tick, time_s, event, colour, state, camera_exposure, has_processed, has_scene);
  }
};

/// Files of a moment's pictures. Their names contain the tick: a process that repeats the tick after a restart writes
/// the same files again, with the same content.
struct MomentFiles {
  std::filesystem::path scene, camera, processed;
  MomentFiles(const std::filesystem::path& folder, const Moment& moment);
};

/// Whether the event gets a row in the figure.
[[nodiscard]] bool is_key_event(std::uint8_t event);

/// Chooses the moments that become rows of the figure, in order of time. If the line or the same colour of object was
/// found several times, the first moment is chosen. If a recovery repeated pregrasped, grasped or dropped, the last one
/// is chosen.
[[nodiscard]] std::vector<Moment> figure_rows(const std::vector<Moment>& moments);

/// Saves the pictures of each moment: the raw image at once, and later the processed image of the same exposure and the
/// picture of the scene, when these two arrive.
struct MomentAlbum {
  std::vector<Moment> moments;

  /// Images given to this class must have the right number of bytes (image_violation()). `camera` may be null. Moments
  /// after the first 100 are ignored, so that the state stays small.
  void add(Moment moment, const std::filesystem::path& folder, const msg::CameraImage* camera);
  void on_processed(const std::filesystem::path& folder, const msg::CameraImage& image);
  void on_scene(const std::filesystem::path& folder, const msg::CameraImage& image);
  /// Saves the newest images for all moments that still have no picture, because no further images arrive after the end
  /// of the run. `processed` and `scene` may be null.
  void finish(const std::filesystem::path& folder, const msg::CameraImage* processed, const msg::CameraImage* scene);

  template <class Archive>
  void serialize(Archive& archive) {
    archive(moments);
  }
};

}  // namespace constrictor::report
