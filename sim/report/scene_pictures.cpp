#include "sim/report/scene_pictures.hpp"

#include <fstream>
#include <future>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "constrictor/reflect.hpp"
#include "constrictor/sha256.hpp"
#include "sim/figure/png.hpp"
#include "sim/overview/lazy_view.hpp"
#include "sim/report/files.hpp"

namespace constrictor::report {
namespace {

std::string digest_of(std::string_view bytes) {
  const Sha256::Digest digest = sha256(std::as_bytes(std::span(bytes)));
  return {digest.begin(), digest.end()};
}

}  // namespace

void save_world(const std::filesystem::path& file, const msg::WorldState& world) {
  std::string bytes;
  canonical_bytes(world, bytes);
  replace_file(file, digest_of(bytes) + bytes);
}

std::shared_ptr<const msg::WorldState> read_world(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  constexpr std::size_t kDigestSize = std::tuple_size_v<Sha256::Digest>;
  if (content.size() < kDigestSize) return nullptr;
  const std::string_view bytes = std::string_view(content).substr(kDigestSize);
  if (digest_of(bytes) != content.substr(0, kDigestSize)) return nullptr;
  return parse_shared<msg::WorldState>(std::as_bytes(std::span(bytes)));
}

void draw_scene_pictures(const std::filesystem::path& folder, const std::vector<Moment>& moments,
                         const msg::SceneDescription& scene, const Eigen::Vector3d& head_camera_m, LostFiles& lost) {
  std::unique_ptr<LazyView> view;  // made for the first picture, because this compiles shaders
  std::future<void> written;       // the picture before, which is compressed while the next one is drawn
  const auto finish = [&] {
    if (written.valid()) lost.attempt([&] { written.get(); });
  };
  for (const Moment& moment : moments) {
    const MomentFiles files(folder, moment);
    const auto world = read_world(files.world);
    if (!world) continue;
    if (!view) view = make_view_lazily(scene, head_camera_m);
    std::vector<std::uint8_t> rgb = view->draw(*world);
    finish();
    written = std::async(std::launch::async,
                         [file = files.scene, width = view->width(), height = view->height(), rgb = std::move(rgb)] {
                           replace_file(file, encode_png(width, height, rgb.data()));
                         });
  }
  finish();
}

void remove_work_files(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;  // without a moment there is no such folder
  for (const auto& entry : std::filesystem::directory_iterator(folder / MomentFiles::kFolder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(MomentFiles::kWorld) || name.starts_with(RawImages::kName)) files.push_back(entry.path());
  }
  for (const auto& file : files) std::filesystem::remove(file, error);
}

}  // namespace constrictor::report
