// Raw images for which a processed image may still come. They are kept in files, so that checkpoints stay small.
#pragma once

#include <array>
#include <cereal/types/array.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor::report {

class LostFiles;

/// A picture in memory: RGB, rows from the top.
struct RawImage {
  std::uint16_t width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// The raw image of the newest processed image, and the newest of those that were kept since then. The files are
/// overwritten, because to create and remove one for each image takes longer than to write it. Each begins with the
/// exposure of its image. After a restart they have the images of the checkpoint, or the repeated tick writes the newer
/// ones again.
class RawImages {
 public:
  static constexpr const char* kName = "raw_";  ///< beginning of the names of the files

  /// Does nothing if the image is kept already. The image must have the right number of bytes. After a file that cannot
  /// be written, which is noted in `lost`, no further one is tried.
  void keep(const std::filesystem::path& folder, const msg::CameraImage& image, LostFiles& lost);
  /// Empty if no image of this exposure is kept, or if its file is damaged.
  [[nodiscard]] std::optional<RawImage> find(const std::filesystem::path& folder, std::int64_t exposure_tick) const;
  /// A processed image of this exposure has come: the images that were exposed before it are not needed any more.
  void forget_before(std::int64_t exposure_tick);

  template <class Archive>
  void serialize(Archive& archive) {
    archive(exposures_, processed_tick_);
  }

 private:
  static constexpr std::int64_t kFree = -1;
  using Exposures = std::array<std::int64_t, 9>;
  Exposures exposures_ = [] {  // of the image in each file
    Exposures none{};
    none.fill(kFree);
    return none;
  }();
  std::int64_t processed_tick_ = kFree;  // exposure of the newest processed image, whose raw image stays
  bool disk_is_full_ = false;
};

}  // namespace constrictor::report
