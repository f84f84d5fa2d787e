#include "sim/report/moments.hpp"

#include <algorithm>
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <string_view>

#include "sim/report/files.hpp"
#include "sim/report/png.hpp"

namespace constrictor::report {
namespace {

constexpr std::size_t kMostMoments = 100;

void save(const std::filesystem::path& file, const msg::CameraImage& image) {
  const cv::Mat rgb(image.height, image.width, CV_8UC3, image.data._buffer);
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  replace_file(file, encode_png(bgr));
}

}  // namespace

MomentFiles::MomentFiles(const std::filesystem::path& folder, const Moment& moment) {
  char prefix[16];
  std::snprintf(prefix, sizeof prefix, "%07lld_", static_cast<long long>(moment.tick));
  scene = folder / "snapshots" / (std::string(prefix) + "scene.png");
  camera = folder / "snapshots" / (std::string(prefix) + "camera.png");
  processed = folder / "snapshots" / (std::string(prefix) + "processed.png");
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

void MomentAlbum::add(Moment moment, const std::filesystem::path& folder, const msg::CameraImage* camera) {
  if (moments.size() >= kMostMoments) return;
  if (!moments.empty() && moments.back().tick == moment.tick) return;  // that moment has the same pictures
  if (camera != nullptr) {
    save(MomentFiles(folder, moment).camera, *camera);
    moment.camera_exposure = camera->exposure_tick;
  }
  moments.push_back(std::move(moment));
}

void MomentAlbum::on_processed(const std::filesystem::path& folder, const msg::CameraImage& image) {
  for (Moment& moment : moments) {
    if (moment.has_processed || moment.camera_exposure < 0 || image.exposure_tick < moment.camera_exposure) continue;
    save(MomentFiles(folder, moment).processed, image);
    moment.has_processed = true;
  }
}

void MomentAlbum::on_scene(const std::filesystem::path& folder, const msg::CameraImage& image) {
  for (Moment& moment : moments) {
    if (moment.has_scene || image.exposure_tick < moment.tick) continue;
    save(MomentFiles(folder, moment).scene, image);
    moment.has_scene = true;
  }
}

void MomentAlbum::finish(const std::filesystem::path& folder, const msg::CameraImage* processed,
                         const msg::CameraImage* scene) {
  for (Moment& moment : moments) {
    if (!moment.has_processed && processed != nullptr) {
      save(MomentFiles(folder, moment).processed, *processed);
      moment.has_processed = true;
    }
    if (!moment.has_scene && scene != nullptr) {
      save(MomentFiles(folder, moment).scene, *scene);
      moment.has_scene = true;
    }
  }
}

}  // namespace constrictor::report
