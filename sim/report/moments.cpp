#include "sim/report/moments.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "sim/figure/png.hpp"
#include "sim/report/files.hpp"
#include "sim/report/scene_pictures.hpp"

namespace constrictor::report {
namespace {

constexpr std::size_t kMostMoments = 100;

bool save(const std::filesystem::path& file, const msg::CameraImage& image, LostFiles& lost) {
  return lost.attempt([&] { replace_file(file, encode_png(image.width, image.height, image.data._buffer)); });
}

/// A moment whose processed image cannot be written keeps none: a later image would show something else.
void save_processed(Moment& moment, const std::filesystem::path& folder, const msg::CameraImage& image,
                    LostFiles& lost) {
  moment.has_processed = save(MomentFiles(folder, moment).processed, image, lost);
  if (!moment.has_processed) moment.camera_exposure = -1;
}

/// Saves a processed image and the raw image of its exposure.
void save_pair(Moment& moment, const std::filesystem::path& folder, const msg::CameraImage& processed,
               const RawImage& raw, LostFiles& lost) {
  moment.camera_exposure = processed.exposure_tick;
  const auto write = [&] {
    replace_file(MomentFiles(folder, moment).camera, encode_png(raw.width, raw.height, raw.rgb.data()));
  };
  if (lost.attempt(write)) save_processed(moment, folder, processed, lost);
  else moment.camera_exposure = -1;
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

void MomentAlbum::add(Moment moment, const std::filesystem::path& folder, const Newest& newest, LostFiles& lost) {
  if (moments.size() >= kMostMoments) return;
  if (!moments.empty() && moments.back().tick == moment.tick) return;  // that moment has the same pictures
  const MomentFiles files(folder, moment);
  std::error_code ignored;  // then no picture can be written either
  std::filesystem::remove(files.scene, ignored);
  if (newest.world != nullptr) lost.attempt([&] { save_world(files.world, *newest.world); });
  if (newest.camera != nullptr && save(files.camera, *newest.camera, lost))
    moment.camera_exposure = newest.camera->exposure_tick;
  // This image may have been processed already.
  if (newest.processed != nullptr && moment.camera_exposure >= 0 &&
      newest.processed->exposure_tick == moment.camera_exposure)
    save_processed(moment, folder, *newest.processed, lost);
  moments.push_back(std::move(moment));
}

void MomentAlbum::on_camera(const std::filesystem::path& folder, const msg::CameraImage& image, LostFiles& lost) {
  const bool needed = std::any_of(moments.begin(), moments.end(), [&](const Moment& moment) {
    return !moment.has_processed && moment.camera_exposure >= 0 &&
           image.exposure_tick - moment.camera_exposure <= kSameMoment_ticks;
  });
  if (needed || processed_are_late) raws.keep(folder, image, lost);
}

void MomentAlbum::on_processed(const std::filesystem::path& folder, const msg::CameraImage& image,
                               const msg::CameraImage* camera, LostFiles& lost) {
  if (camera != nullptr && camera->exposure_tick > image.exposure_tick) processed_are_late = true;
  if (camera != nullptr && camera->exposure_tick == image.exposure_tick) raws.keep(folder, *camera, lost);
  for (Moment& moment : moments) {
    const std::int64_t later_ticks = image.exposure_tick - moment.camera_exposure;
    if (moment.has_processed || moment.camera_exposure < 0 || later_ticks < 0 || later_ticks > kSameMoment_ticks)
      continue;
    if (later_ticks == 0) save_processed(moment, folder, image, lost);
    else if (const auto raw = raws.find(folder, image.exposure_tick)) save_pair(moment, folder, image, *raw, lost);
  }
  raws.forget_before(image.exposure_tick);
}

void MomentAlbum::finish(const std::filesystem::path& folder, const msg::CameraImage& processed, LostFiles& lost) {
  for (Moment& moment : moments) {
    if (moment.has_processed) continue;
    const std::int64_t seen_tick = moment.camera_exposure >= 0 ? moment.camera_exposure : moment.tick;
    if (std::abs(processed.exposure_tick - seen_tick) > kSameMoment_ticks) continue;
    if (moment.camera_exposure < 0 || processed.exposure_tick == moment.camera_exposure)
      save_processed(moment, folder, processed, lost);
    else if (const auto raw = raws.find(folder, processed.exposure_tick))
      save_pair(moment, folder, processed, *raw, lost);
  }
}

}  // namespace constrictor::report
