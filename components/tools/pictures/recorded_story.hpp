// The events of a recorded run, without worlds and images: read in one pass, before anything is drawn.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "constrictor/messages.hpp"
#include "sim/figure/panels.hpp"
#include "sim/report/moments.hpp"

namespace constrictor::pictures {

/// A recording or a choice of which no picture can be made: the message says what to do. Exit status 78.
class NoPicture : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// [s] time of a message: simulated, or the robot's own.
inline double seconds(const msg::Header& header) { return static_cast<double>(header.time_ns) * 1e-9; }

/// How the pixels of images come.
enum class Images {
  kNone,      ///< there are none, and they cannot be computed
  kRecorded,  ///< they are in the recording
  kComputed   ///< camera and perception must be replayed
};

/// The last epoch of a recording. Times are simulated, or the robot's own.
struct RecordedStory {
  std::filesystem::path file;
  std::uint64_t run_id = 0;
  std::uint32_t epoch = 0;
  std::uint32_t epochs = 0;  ///< in the recording
  double from_s = 0.0, to_s = 0.0;
  std::shared_ptr<const msg::SceneDescription> scene;  ///< null: there is no simulated world
  Eigen::Vector3d head_camera_m{0.0, 0.0, 0.0};        ///< p_HC
  figure::TorqueSeries torques;                        ///< of the yaw joints
  std::vector<std::pair<double, std::string>> states;  ///< of the planner: since when [s]
  std::vector<report::Moment> events;                  ///< all of them, with the planner's state; without pictures
  double mission_end_s = -1.0;                         ///< negative: the planner has not ended the mission
  std::uint8_t outcome = msg::kMissionRunning;
  std::string reason;  ///< why the mission has failed
  std::string scenario;
  std::uint64_t seed = 0;
  Images images = Images::kNone;
  std::string no_images;  ///< why there are none, and what to do; empty: there are

  /// The state of the planner at a time.
  [[nodiscard]] std::string state_at(double time_s) const;
};

/// Reads a recording. `stopped` is asked now and then and may end it by an exception. Throws mcap::Error, or NoPicture
/// if the recording has nothing to draw.
[[nodiscard]] RecordedStory read_story(const std::filesystem::path& file, const std::function<void()>& stopped);

}  // namespace constrictor::pictures
