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

/// Files of a moment's pictures. They are named by tick, so that a tick that is done again after a restart writes the
/// same files with the same content.
struct MomentFiles {
  std::filesystem::path scene, camera, processed;
  MomentFiles(const std::filesystem::path& folder, const Moment& moment);
};

/// Whether the event gets a row in the figure.
[[nodiscard]] bool is_key_event(std::uint8_t event);

/// Chooses the moments that become rows of the figure, in order of time. Of several findings of the same colour the
/// first is chosen; of events that may be repeated after a recovery (pregrasped, grasped, dropped) the last.
[[nodiscard]] std::vector<Moment> figure_rows(const std::vector<Moment>& moments);

/// Saves the pictures of moments as they become visible: the raw image at once; the processed image of the same
/// exposure and the picture of the scene when they arrive.
struct MomentAlbum {
  std::vector<Moment> moments;

  /// All images given to this class must be whole. Moments after the first 100 are ignored, so that the state stays
  /// small; `camera` may be null.
  void add(Moment moment, const std::filesystem::path& folder, const msg::CameraImage* camera);
  void on_processed(const std::filesystem::path& folder, const msg::CameraImage& image);
  void on_scene(const std::filesystem::path& folder, const msg::CameraImage& image);
  /// At the end of the run no further images arrive: moments without a picture receive the newest ones, which may be
  /// null.
  void finish(const std::filesystem::path& folder, const msg::CameraImage* processed, const msg::CameraImage* scene);

  template <class Archive>
  void serialize(Archive& archive) {
    archive(moments);
  }
};

}  // namespace constrictor::report
