// Whether something is in view, debounced over images: one image with it, or without it, does not decide.
#pragma once

#include <string>

#include "configuration/parameter_set.hpp"

namespace constrictor {

struct Visibility {
  int seen = 0;          ///< consecutive images that showed it
  int missed = 0;        ///< consecutive images that did not show it
  bool visible = false;  ///< debounced
};

struct DebounceConfig : ParameterSet {
  int found_after = 0;
  int lost_after = 0;

 protected:
  /// Adds the two rows. `what`: begins their meaning, for example "The line". `lost_images`: default of the second.
  DebounceConfig(const std::string& what, int lost_images) {
    found_after = add(found_after, "found_after_images", 3, "images", {1, 100}, kWhileRunning,
                      what + " is visible after this number of consecutive images with it");
    lost_after = add(lost_after, "lost_after_images", lost_images, "images", {1, 100}, kWhileRunning,
                     what + " is not visible after this number of consecutive images without it");
  }
};

/// Updates `state` with the next image. `shown`: the image shows the line, object or zone.
inline void debounce(const DebounceConfig& config, bool shown, Visibility& state) {
  state.seen = shown ? state.seen + 1 : 0;
  state.missed = shown ? 0 : state.missed + 1;
  if (state.seen >= config.found_after) state.visible = true;
  if (state.missed >= config.lost_after) state.visible = false;
}

}  // namespace constrictor
