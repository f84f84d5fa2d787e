#include "sim/report/moments.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "sim/figure/png.hpp"
#include "sim/report/files.hpp"
#include "sim/report/scene_pictures.hpp"

namespace constrictor::report {
namespace {

constexpr std::size_t kMostMoments = 100;

void save(const std::filesystem::path& file, const msg::CameraImage& image) {
  replace_file(file, encode_png(image.width, image.height, image.data._buffer));
}

/// A moment whose processed image cannot be written keeps none: a later image would show something else.
void save_processed(Moment& moment, const std::filesystem::path& folder, const msg::CameraImage& image,
                    LostFiles& lost) {
  moment.has_processed = lost.attempt([&] { save(MomentFiles(folder, moment).processed, image); });
  if (!moment.has_processed) moment.camera_exposure = -1;
}

}  // namespace

MomentFiles::MomentFiles(const std::filesystem::path& folder, const Moment& moment) {
  char tick[32];
  std::snprintf(tick, sizeof tick, "%07lld", static_cast<long long>(moment.tick));
  const auto file = [&](const std::string& end) { return folder / kFolder / (tick + end); };
  scene = file("_scene.png");
  camera = file("_camera.png");
  processed = file("_processed.png");
  world = file(kWorld);
}

bool is_key_event(std::uint8_t event) {
  switch (event) {
    case msg::kEventLineFound:
    case msg::kEventObjectFound:
    case msg::kEventObjectPregrasped:
    case msg::kEventObjectGrasped:
    case msg::kEventDroppingDone:
      return true;
    default:
      return false;
  }
}

std::vector<Moment> figure_rows(const std::vector<Moment>& moments) {
  std::vector<Moment> rows;
  for (const Moment& moment : moments) {
    const bool finding = moment.event == msg::kEventLineFound || moment.event == msg::kEventObjectFound;
    const auto same = std::find_if(rows.begin(), rows.end(), [&](const Moment& row) {
      return row.event == moment.event && (row.colour == moment.colour || moment.event == msg::kEventLineFound);
    });
    if (same != rows.end() && finding) continue;
    if (same != rows.end()) rows.erase(same);
    rows.push_back(moment);
  }
  return rows;
}

std::vector<Moment> merge_end(std::vector<Moment> rows) {
  constexpr double kSamePictures_s = 2.0;
  if (rows.size() < 2 || rows.back().event != msg::kEventNone) return rows;
  if (rows.back().time_s - rows[rows.size() - 2].time_s >= kSamePictures_s) return rows;
  rows.pop_back();
  rows.back().ends = true;
  return rows;
}

void MomentAlbum::add(Moment moment, const std::filesystem::path& folder, const msg::CameraImage* camera,
                      const msg::WorldState* world, LostFiles& lost) {
  if (moments.size() >= kMostMoments) return;
  if (!moments.empty() && moments.back().tick == moment.tick) return;  // that moment has the same pictures
  const MomentFiles files(folder, moment);
  std::error_code ignored;  // then no picture can be written either
  std::filesystem::remove(files.scene, ignored);
  if (world != nullptr) lost.attempt([&] { save_world(files.world, *world); });
  if (camera != nullptr && lost.attempt([&] { save(files.camera, *camera); }))
    moment.camera_exposure = camera->exposure_tick;
  moments.push_back(std::move(moment));
}

void MomentAlbum::on_processed(const std::filesystem::path& folder, const msg::CameraImage& image, LostFiles& lost) {
  for (Moment& moment : moments) {
    if (moment.has_processed || moment.camera_exposure < 0 || image.exposure_tick < moment.camera_exposure) continue;
    save_processed(moment, folder, image, lost);
  }
}

void MomentAlbum::finish(const std::filesystem::path& folder, const msg::CameraImage& processed, LostFiles& lost) {
  for (Moment& moment : moments) {
    if (moment.has_processed) continue;
    save_processed(moment, folder, processed, lost);
  }
}

}  // namespace constrictor::report
