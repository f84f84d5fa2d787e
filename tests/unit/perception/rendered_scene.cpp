#include "rendered_scene.hpp"

#include <cstring>

#include "sim/render/pixel_noise.hpp"

namespace constrictor::testing {
namespace {

constrictor::Scene convert(const Scene& from) {
  constrictor::Scene to;
  if (from.line) {
    for (double s = 0.0; s <= from.line->length_m; s += 0.02) to.line_m.push_back(from.line->at(s));
    to.line_width_m = from.line->width_m;
    to.line_colour = colour_reflectance(from.line->colour);
  }
  for (const Round& r : from.rounds) {
    if (r.height_m > 0.0) {
      to.objects.push_back({SolidShape::kCylinder, {r.radius_m, r.radius_m, r.height_m}, colour_reflectance(r.colour)});
    } else {
      to.zones.push_back({r.centre, r.radius_m, colour_reflectance(r.colour)});
    }
  }
  const Eigen::Vector3f ground = from.ground_colour.cast<float>();
  to.ground_colour = {ground.x(), ground.y(), ground.z()};
  to.ground_gloss = from.ground_gloss;
  to.light = {from.light.normalized(), from.light_intensity, from.ambient};
  return to;
}

}  // namespace

RenderedScene::RenderedScene(const Scene& scene)
    : scene_(scene), renderer_(std::make_unique<Renderer>(convert(scene), RenderOptions{})) {
  for (const Round& r : scene.rounds) {
    if (r.height_m <= 0.0) continue;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Eigen::Vector3d(r.centre.x(), r.centre.y(), 0.5 * r.height_m);
    poses_.X_WObject.push_back(pose);
  }
}

RenderedScene::~RenderedScene() = default;

cv::Mat RenderedScene::draw(const msg::CameraInfo& info, const Head& head, double tilt_rad) {
  Eigen::Isometry3d X_WH = Eigen::Isometry3d::Identity();
  X_WH.linear() = (Eigen::AngleAxisd(head.pitch_rad, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(head.roll_rad, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  X_WH.translation().z() = head.height_m;
  poses_.X_WModule.assign(24, X_WH);
  for (std::size_t i = 1; i < 24; ++i) poses_.X_WModule[i].translation().x() -= 0.089 * static_cast<double>(i);

  PinholeCamera camera{info.width, info.height, info.fx, info.fy, info.cx, info.cy, Eigen::Isometry3d::Identity()};
  const auto& p = info.X_HC.position_m;
  Eigen::Isometry3d X_HC = Eigen::Isometry3d::Identity();
  X_HC.translation() = Eigen::Vector3d(p.x, p.y, p.z);
  X_HC.linear().col(0) = Eigen::Vector3d(0, -1, 0);
  X_HC.linear().col(1) = Eigen::Vector3d(-std::sin(tilt_rad), 0, -std::cos(tilt_rad));
  X_HC.linear().col(2) = Eigen::Vector3d(std::cos(tilt_rad), 0, -std::sin(tilt_rad));
  camera.X_WC = X_WH * X_HC;

  std::vector<std::uint8_t> rgb = renderer_->draw(poses_, camera, {{1.0, 0.0}, 3.0});
  PixelNoise(scene_.noise_sd, scene_.seed).add(rgb, 1);
  cv::Mat image(info.height, info.width, CV_8UC3);
  std::memcpy(image.data, rgb.data(), rgb.size());
  return image;
}

}  // namespace constrictor::testing
