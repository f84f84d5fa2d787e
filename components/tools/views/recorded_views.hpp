// The views of a recorded run: made from its messages, one after the other, as the dashboard makes them live.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "recording/mcap_format.hpp"
#include "views/newest.hpp"
#include "views/view_topics.hpp"

namespace constrictor::views {

class RecordedViews {
 public:
  using Write = std::function<void(View view, std::uint64_t time_ns, std::string_view data)>;
  explicit RecordedViews(Write write) : write_(std::move(write)) {}

  /// Takes a message over, and writes the views that change with it. `time_ns`: the log time of the message, which
  /// becomes that of the views. Messages that no view needs, or that violate the contract, are left out.
  void take(const std::string& topic, mcap::Bytes cdr, std::uint64_t time_ns);

 private:
  void write(View view, std::uint64_t time_ns, const nlohmann::json& message);
  void write_image(View view, const msg::CameraImage& image, std::uint64_t time_ns);
  void take_world(const msg::WorldState& world, std::uint64_t time_ns);

  Write write_;
  Newest newest_;
  std::uint64_t scene_ns_ = 0;  ///< log time of the newest scene
  bool scene_written_ = false;
};

}  // namespace constrictor::views
