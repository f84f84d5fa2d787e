// Replays components of a recorded run, without DDS: each gets the inputs that it had, and its outputs are compared
// with the recorded ones.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "component/component.hpp"
#include "constrictor/topics.hpp"
#include "recording/mcap_format.hpp"

namespace constrictor {

/// The first difference between what a component wrote in the run and in the replay.
struct ReplayDifference {
  std::int64_t tick = 0;
  std::string topic;
  std::string field;  ///< empty: one of the two messages is missing, or only pixels that were not recorded differ
  std::string recorded;
  std::string replayed;
};

struct ReplayResult {
  std::string component;
  std::uint64_t steps = 0;
  std::uint64_t messages = 0;  ///< that were compared
  std::optional<ReplayDifference> difference;
  std::string stopped;  ///< why the replay ended before the recording; empty: it did not
};

/// Makes the factory of a component; nothing if there is no such component.
using FindFactory = std::function<std::optional<ComponentFactory>(const std::string& name)>;

/// Functions that a replay calls with the messages that it reads, and with the images that it computes again. It passes
/// no other computed message on. A function may end the replay by an exception.
struct ReplayHooks {
  std::function<void(const mcap::Channel&, const mcap::Message&)> message;  ///< each one, in the order of the file
  /// Called with each image that was not recorded and has been computed again.
  std::function<void(const TopicInfo&, const std::shared_ptr<const msg::CameraImage>&)> image;
};

/// Replays `components` in one pass over the recording. A component whose input images were not recorded (--images off
/// or recompute) is replayed together with the components that make these images. Throws mcap::Error if the recording
/// cannot be read, and ConfigurationError if it is not that of a run of this release, or if it has no such component.
/// `output`: a folder in which the components write their files, those at the end of the run included (report draws its
/// figure); empty: nothing of what they write is kept.
[[nodiscard]] std::vector<ReplayResult> replay_components(const std::filesystem::path& recording,
                                                          const std::vector<std::string>& components,
                                                          const FindFactory& find,
                                                          const std::filesystem::path& output = {},
                                                          const ReplayHooks& hooks = {});

/// Writes a copy of a recording that was made with --images recompute, with all images: the components that make them
/// are replayed, and their results returned. Throws as replay_components() does.
[[nodiscard]] std::vector<ReplayResult> restore_images(const std::filesystem::path& recording,
                                                       const std::filesystem::path& restored, const FindFactory& find);

/// constrictor_host --replay FILE [--output DIR] NAME..., or --replay FILE --restore OUT: prints the results.
/// `arguments`: those after --replay. Returns the exit status: 1 if a component differs or was stopped.
int replay_main(const std::vector<std::string>& arguments, const FindFactory& find);

}  // namespace constrictor
