// The second pass over a recording: what was to be seen at given times.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "constrictor/messages.hpp"
#include "pictures/recorded_story.hpp"

namespace constrictor::pictures {

/// Which images belong to a time.
enum class Choice {
  kNewest,  ///< the newest raw image, and the newest processed one that was not exposed after it
  kPair     ///< raw and processed image of one exposure: the first pair from the newest raw image on, or the one before
};

/// What was to be seen at a time; null: there is none.
struct Seen {
  double time_s = 0.0;
  std::shared_ptr<const msg::WorldState> world;
  std::shared_ptr<const msg::CameraImage> camera;  ///< with the right number of bytes, as `processed`
  std::shared_ptr<const msg::CameraImage> processed;
};

/// Calls `use` for each of the times, which rise. It may end the pass by an exception. Images that were not recorded
/// are computed again if the story says that they can be. Throws mcap::Error. Returns what went wrong with these
/// images; empty: nothing. Images of a pair were exposed at most report::kSameMoment_ticks from the newest raw image;
/// if there is no such pair, that one is shown alone.
std::string feed_pictures(const RecordedStory& story, const std::vector<double>& times_s, Choice choice,
                          const std::function<void(const Seen&)>& use);

}  // namespace constrictor::pictures
