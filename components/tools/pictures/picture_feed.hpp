// The second pass over a recording: what was to be seen at given times.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "constrictor/messages.hpp"
#include "pictures/recorded_story.hpp"

namespace constrictor::pictures {

/// The newest of each kind at a time; null: there is none.
struct Seen {
  double time_s = 0.0;
  std::shared_ptr<const msg::WorldState> world;
  std::shared_ptr<const msg::CameraImage> camera;     ///< with the right number of bytes, as `processed`
  std::shared_ptr<const msg::CameraImage> processed;  ///< of the same exposure, or of the newest before it
};

/// Calls `use` for each of the times, which rise. It may end the pass by an exception. Images that were not recorded
/// are computed again if the story says that they can be. Throws mcap::Error. Returns what went wrong with these
/// images; empty: nothing.
std::string feed_pictures(const RecordedStory& story, const std::vector<double>& times_s,
                          const std::function<void(const Seen&)>& use);

}  // namespace constrictor::pictures
