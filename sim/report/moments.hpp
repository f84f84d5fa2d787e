// Key moments of a run and their pictures: the rows of the figure.
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
  std::uint8_t event = msg::kEventNone;   ///< kEventNone: the mission's end
  std::uint8_t colour = msg::kColourUnknown;
  std::string state;                      ///< the planner's
  std::int64_t camera_exposure = -1;      ///< of the raw image; -1: there is none
  bool has_processed = false;
  bool has_scene = false;

  template <class Archive>
  void serialize(Archive& archive) { archive(tick, time_s, event, colour, state, camera_exposure, has_processed, has_scene); }
};

/// Files of a moment's pictures, named by tick, so that redone ticks write them again with the same content.
struct MomentFiles {
  std::filesystem::path scene, camera, processed;
  MomentFiles(const std::filesystem::path& folder, const Moment& moment);
};

/// True for events that get a row in the figure.
[[nodiscard]] bool is_key_event(std::uint8_t event);

/// What a row of the figure is chosen from: the first of its kind for findings, the last for what may be repeated after a
/// recovery, in order of time.
[[nodiscard]] std::vector<Moment> figure_rows(const std::vector<Moment>& moments);

/// Whether an image's data are the RGB pixels that its size promises.
[[nodiscard]] bool is_whole(const msg::CameraImage& image);

/// Collects the pictures of moments as they become visible: the raw image at once, the processed one of the same exposure and
/// the scene's as they come.
struct MomentAlbum {
  std::vector<Moment> moments;

  /// Images must be whole. Nothing beyond a bound that no mission reaches, so that the state stays small.
  void add(Moment moment, const std::filesystem::path& folder, const msg::CameraImage* camera);
  void on_processed(const std::filesystem::path& folder, const msg::CameraImage& image);
  void on_scene(const std::filesystem::path& folder, const msg::CameraImage& image);

  template <class Archive>
  void serialize(Archive& archive) { archive(moments); }
};

}  // namespace constrictor::report
