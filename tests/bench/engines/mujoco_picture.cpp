#include "bench/engines/mujoco_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace constrictor {
namespace {

using Eigen::Vector3d;

constexpr double kGroundHalf_m = 4.0;  ///< the ground is a square with this half edge
constexpr int kTexels = 1024;          ///< along an edge of the ground's texture

std::string numbers_of(const Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }
std::string rgba(const Rgb& colour) { return fmt::format("{} {} {} 1", colour.r, colour.g, colour.b); }

std::string pose_of(const Eigen::Isometry3d& X) {
  const Eigen::Quaterniond q(X.linear());
  return fmt::format(R"(pos="{}" quat="{} {} {} {}")", numbers_of(X.translation()), q.w(), q.x(), q.y(), q.z());
}

std::string bodies_of(const Scene& scene, const ScenePoses& poses) {
  std::string text;
  for (const Eigen::Isometry3d& X : poses.X_WModule) {
    const Vector3d half = 0.5 * scene.module_length_m * X.linear().col(0);
    text += fmt::format(R"(<geom type="capsule" size="{}" fromto="{} {}" rgba="0.3 0.3 0.32 1"/>)",
                        scene.module_radius_m, numbers_of(X.translation() + half), numbers_of(X.translation() - half));
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Solid& solid = scene.objects[i];
    const bool box = solid.shape == SolidShape::kBox;
    const std::string size =
        box ? numbers_of(0.5 * solid.size_m) : fmt::format("{} {}", solid.size_m.x(), 0.5 * solid.size_m.z());
    text += fmt::format(R"(<geom type="{}" size="{}" {} rgba="{}"/>)", box ? "box" : "cylinder", size,
                        pose_of(poses.X_WObject[i]), rgba(solid.colour));
  }
  return text;
}

/// The scene as a MuJoCo model (MJCF). MuJoCo multiplies the lengths of `<visual>` (znear, zfar, shadowclip) by
/// `extent`; this is 1 m, so that they are in metres.
std::string model_text(const Scene& scene, const ScenePoses& poses, const PinholeCamera& camera,
                       const ShadowRegion& region, int shadow_map_size) {
  const Eigen::Matrix3d& R = camera.X_WC.linear();
  const double fovy_deg = 360.0 / std::numbers::pi * std::atan2(0.5 * camera.height, camera.fy);
  const Vector3d light_at = Vector3d(region.centre_m.x(), region.centre_m.y(), 0.0) + 3.0 * scene.light.direction;
  return fmt::format(
      R"(<mujoco><statistic extent="1" center="0 0 0"/><visual><headlight active="0"/>)"
      R"(<global offwidth="{}" offheight="{}"/><map znear="0.02" zfar="20" shadowclip="{}"/>)"
      R"(<quality shadowsize="{}" offsamples="0"/></visual>)"
      R"(<asset><texture name="ground" type="2d" builtin="flat" rgb1="0.5 0.5 0.5" width="{}" height="{}"/>)"
      R"(<material name="ground" texture="ground" texrepeat="1 1" specular="0"/></asset>)"
      R"(<worldbody><light directional="true" castshadow="{}" pos="{}" dir="{}" ambient="{} {} {}" diffuse="{} {} {}" )"
      R"(specular="0 0 0"/><geom type="plane" size="{} {} 0.1" material="ground"/>)"
      R"(<camera name="head" pos="{}" xyaxes="{} {}" fovy="{}"/>{}</worldbody></mujoco>)",
      camera.width, camera.height, region.radius_m, std::max(1, shadow_map_size), kTexels, kTexels, shadow_map_size > 0,
      numbers_of(light_at), numbers_of(-scene.light.direction), scene.light.ambient, scene.light.ambient,
      scene.light.ambient, scene.light.intensity, scene.light.intensity, scene.light.intensity, kGroundHalf_m,
      kGroundHalf_m, numbers_of(camera.X_WC.translation()), numbers_of(R.col(0)), numbers_of(-R.col(1)), fovy_deg,
      bodies_of(scene, poses));
}

/// Whether the point is nearer to the line than half of its width. The points of the line are closer to each other than
/// that.
bool on_line(const Scene& scene, const Eigen::Vector2d& p) {
  const double half_m = 0.5 * scene.line_width_m;
  return std::ranges::any_of(scene.line_m, [&](const auto& q) { return (p - q).squaredNorm() < half_m * half_m; });
}

void paint_ground(const Scene& scene, mjModel& model) {
  for (int row = 0; row < kTexels; ++row) {
    for (int column = 0; column < kTexels; ++column) {
      // The first row of a plane's texture is at the side of the greatest y.
      const Eigen::Vector2d p = 2.0 * kGroundHalf_m / kTexels * Eigen::Vector2d(column + 0.5, kTexels - row - 0.5) -
                                Eigen::Vector2d::Constant(kGroundHalf_m);
      Rgb colour = scene.ground_colour;
      for (const Disc& zone : scene.zones)
        if ((p - zone.centre_m).norm() < zone.radius_m) colour = zone.colour;
      if (on_line(scene, p)) colour = scene.line_colour;
      mjtByte* const texel = model.tex_rgb + model.tex_adr[0] + 3 * (row * kTexels + column);
      const double grain = 0.9 + 0.2 * ((row * 7919 + column * 104729) % 97) / 97.0;
      const std::array<double, 3> rgb{colour.r, colour.g, colour.b};
      for (std::size_t i = 0; i < 3; ++i)
        texel[i] = static_cast<mjtByte>(std::clamp(255.0 * grain * rgb[i], 0.0, 255.0));
    }
  }
}

[[noreturn]] void fail(const char* what) { throw std::runtime_error(fmt::format("MuJoCo's renderer: {}", what)); }

}  // namespace

MujocoPicture::MujocoPicture(const Scene& scene, const ScenePoses& poses, const PinholeCamera& camera,
                             const ShadowRegion& region, int shadow_map_size)
    : model_(testing::compile_mujoco_model(model_text(scene, poses, camera, region, shadow_map_size))),
      data_(mj_makeData(model_.get())),
      view_{0, 0, camera.width, camera.height},
      window_(4 * 4 * 4),
      rgb_(static_cast<std::size_t>(3) * camera.width * camera.height) {
  paint_ground(scene, *model_);
  mj_forward(model_.get(), data_.get());
  make_context();
  mjv_defaultScene(&scene_);
  mjv_defaultOption(&options_);
  mjv_defaultCamera(&camera_);
  camera_.type = mjCAMERA_FIXED;
  camera_.fixedcamid = mj_name2id(model_.get(), mjOBJ_CAMERA, "head");
  mjv_makeScene(model_.get(), &scene_, 200);
  scene_.flags[mjRND_SHADOW] = shadow_map_size > 0;
  scene_.flags[mjRND_REFLECTION] = scene_.flags[mjRND_SKYBOX] = scene_.flags[mjRND_HAZE] = scene_.flags[mjRND_FOG] = 0;
}

// MuJoCo finds the functions of OpenGL by itself; they belong to the context that is current.
void MujocoPicture::make_context() {
  // Without a profile of OpenGL 3: MuJoCo uses the functions of OpenGL 1.5 and framebuffer objects.
  context_ = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, nullptr);
  if (!context_) fail("OSMesaCreateContextExt made no context with a depth of 24 bits");
  if (OSMesaMakeCurrent(context_, window_.data(), GL_UNSIGNED_BYTE, 4, 4) != GL_TRUE) fail("OSMesaMakeCurrent failed");
  mjr_defaultContext(&renderer_);
  mjr_makeContext(model_.get(), &renderer_, mjFONTSCALE_100);
  mjr_setBuffer(mjFB_OFFSCREEN, &renderer_);
  if (renderer_.currentBuffer != mjFB_OFFSCREEN) fail("mjr_makeContext made no framebuffer on OSMesa");
}

MujocoPicture::~MujocoPicture() {
  mjr_freeContext(&renderer_);
  mjv_freeScene(&scene_);
  OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
  OSMesaDestroyContext(context_);
}

const std::vector<std::uint8_t>& MujocoPicture::draw() {
  mjv_updateScene(model_.get(), data_.get(), &options_, nullptr, &camera_, mjCAT_ALL, &scene_);
  mjr_render(view_, &scene_, &renderer_);
  mjr_readPixels(rgb_.data(), nullptr, view_, &renderer_);
  if (mjr_getError() != 0) fail("mjr_render reports an error of OpenGL");
  return rgb_;
}

}  // namespace constrictor
