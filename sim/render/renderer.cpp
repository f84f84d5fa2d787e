#include "sim/render/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

#include "sim/render/bodies.hpp"
#include "sim/render/gl_handles.hpp"
#include "sim/render/gl_uniforms.hpp"
#include "sim/render/ground_texture.hpp"
#include "sim/render/meshes.hpp"
#include "sim/render/projection.hpp"
#include "sim/render/render_targets.hpp"
#include "sim/render/shader_compiler.hpp"
#include "sim/render/shaders.hpp"
#include "sim/render/visibility.hpp"

namespace constrictor {
namespace {

constexpr double kNear_m = 0.008;
constexpr double kFar_m = 250.0;
constexpr double kGroundHalfExtent_m = 200.0;
constexpr double kNormalOffset_m = 0.006;  // by which the look-up of a solid's shadow is moved off its surface
constexpr Rgb kHorizon{0.80F, 0.79F, 0.77F};
constexpr Rgb kHead{0.50F, 0.50F, 0.49F};
constexpr Rgb kDarkModule{0.045F, 0.045F, 0.048F};
constexpr Rgb kGreyModule{0.24F, 0.24F, 0.245F};

/// Draws into this framebuffer from now on, with a depth test.
void begin_pass(const GlFramebuffer& framebuffer, int width, int height) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.get());
  glViewport(0, 0, width, height);
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
}

/// The finished shadow map, and the pixels at which bodies may throw shadows on the ground.
struct Shadows {
  const GlTexture& map;
  PixelBox on_ground;
  int size;  ///< [texel] edge of the map; 0: no shadows
};

}  // namespace

class Renderer::Implementation {
 public:
  Implementation(const Scene& scene, const RenderOptions& options);
  ~Implementation() {
    // OpenGL's objects must be freed while the context is current; this scope keeps it current until they are.
    last_scope_.emplace(context_);
  }
  const std::vector<std::uint8_t>& draw(const ScenePoses& poses, const PinholeCamera& camera,
                                        const ShadowRegion& region);

 private:
  void build_meshes();
  void build_textures();
  void place(const ScenePoses& poses);
  /// Chooses the solids for the next draw_solids(). Returns whether there is one.
  bool choose_solids(const Needed& needed);
  void draw_solids() const;
  /// [texel] edge of the shadow map; 0: no shadows.
  [[nodiscard]] int shadow_map_size(const ShadowRegion& region) const {
    return region.coarse ? options_.shadow_map_size / 2 : options_.shadow_map_size;
  }
  Shadows draw_shadow_map(const PinholeCamera& camera, const ViewVolume& view, const Eigen::Matrix4f& shadow, int size);
  void draw_image(const ImageTarget& target, const PinholeCamera& camera, const ViewVolume& view,
                  const Eigen::Matrix4f& shadow, const Shadows& shadows);
  /// `use` begins to draw with a program.
  void draw_flats(const std::function<void(const GlProgram&)>& use, const Needed& visible, const PixelBox& image,
                  const PixelBox& shadowed);

  Scene scene_;
  RenderOptions options_;
  GlContext context_;
  // The order of the members matters: the scope is destroyed after the OpenGL objects below it and before the context.
  std::optional<ContextScope> last_scope_;
  GlProgram solid_program_, flat_program_, lit_flat_program_, depth_program_;
  Solids head_, modules_, cylinders_, boxes_;
  std::vector<Flat> flats_;  // painted in this order
  GlTexture pattern_;
  ShadowMap shadow_map_, coarse_shadow_map_, no_shadows_;
  ImageTargets targets_;
  ShaderCompilerMemory compiler_memory_;
};

Renderer::Implementation::Implementation(const Scene& scene, const RenderOptions& options)
    : scene_(scene), options_(options) {
  if (options.samples != 1 && options.samples != 4) {
    throw std::runtime_error("renderer: samples: found " + std::to_string(options.samples) + ", accepted 1 or 4");
  }
  if (scene.X_WObstacle.size() != scene.obstacles.size())
    throw std::runtime_error("renderer: found " + std::to_string(scene.X_WObstacle.size()) + " poses, accepted " +
                             std::to_string(scene.obstacles.size()) + " (one for each obstacle)");
  const ContextScope scope(context_);
  const std::string lighting = shaders::lighting(options.shadow_taps);
  solid_program_ = build_program(shaders::kSolidVertex, (lighting + shaders::kSolidFragment).c_str());
  const std::string flat = shaders::flat_fragment(scene.ground_gloss > 0.0);
  flat_program_ = build_program(shaders::kFlatVertex, (lighting + flat).c_str());
  lit_flat_program_ = build_program(shaders::kFlatVertex, (shaders::lighting(0) + flat).c_str());
  depth_program_ = build_program(shaders::kSolidVertex, shaders::kDepthFragment);
  build_meshes();
  build_textures();
  shadow_map_.build(options.shadow_map_size);
  no_shadows_.build(0);
  check_gl("building the scene");
}

void Renderer::Implementation::build_meshes() {
  const int segments = options_.module_segments;
  head_.build(make_head(scene_.module_length_m, scene_.module_radius_m, segments, segments / 4));
  modules_.build(make_module(scene_.module_length_m, scene_.module_radius_m, segments, segments / 4));
  cylinders_.build(make_cylinder(48));
  boxes_.build(make_box());
  flats_.emplace_back(make_square(kGroundHalfExtent_m), scene_.ground_colour, 1.0F);
  for (const Disc& zone : scene_.zones)
    flats_.emplace_back(make_disc(zone.centre_m, zone.radius_m, 64), zone.colour, 0.5F);
  const Mesh ribbon = make_ribbon(scene_.line_m, scene_.line_width_m);
  if (!ribbon.indices.empty()) flats_.emplace_back(ribbon, scene_.line_colour, 0.3F);
}

void Renderer::Implementation::build_textures() {
  const std::vector<std::uint8_t> texels = make_ground_texture();
  pattern_ = GlTexture::create();
  glBindTexture(GL_TEXTURE_2D, pattern_.get());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, kGroundTextureSize, kGroundTextureSize, 0, GL_RED, GL_UNSIGNED_BYTE,
               texels.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

void Renderer::Implementation::place(const ScenePoses& poses) {
  for (Solids* solids : {&head_, &modules_, &cylinders_, &boxes_}) solids->clear();
  for (std::size_t i = 0; i < poses.X_WModule.size(); ++i) {
    const Rgb& colour = i == 0 ? kHead : i % 2 == 1 ? kDarkModule : kGreyModule;
    (i == 0 ? head_ : modules_).add(poses.X_WModule[i], Eigen::Vector3d::Ones(), colour, 0.15);
  }
  if (options_.head_camera_m && !poses.X_WModule.empty()) {
    const Eigen::Isometry3d X_WBox = poses.X_WModule[0] * Eigen::Translation3d(*options_.head_camera_m);
    boxes_.add(X_WBox, {0.03, 0.045, 0.03}, kDarkModule, 0.2);
    const Eigen::Isometry3d X_WLens = X_WBox * Eigen::Translation3d(0.016, 0.0, 0.0) *
                                      Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitY());
    cylinders_.add(X_WLens, {0.010, 0.010, 0.008}, kGreyModule, 0.5);
  }
  const auto place_solid = [this](const Solid& solid, const Eigen::Isometry3d& X_W) {
    (solid.shape == SolidShape::kBox ? boxes_ : cylinders_).add(X_W, solid.size_m, solid.colour, 0.05);
  };
  for (std::size_t i = 0; i < scene_.objects.size() && i < poses.X_WObject.size(); ++i)
    place_solid(scene_.objects[i], poses.X_WObject[i]);
  for (std::size_t i = 0; i < scene_.obstacles.size(); ++i) place_solid(scene_.obstacles[i], scene_.X_WObstacle[i]);
}

bool Renderer::Implementation::choose_solids(const Needed& needed) {
  bool any = false;
  for (Solids* solids : {&head_, &modules_, &cylinders_, &boxes_}) any |= solids->choose(needed);
  return any;
}

void Renderer::Implementation::draw_solids() const {
  for (const Solids* solids : {&head_, &modules_, &cylinders_, &boxes_}) solids->draw();
}

Shadows Renderer::Implementation::draw_shadow_map(const PinholeCamera& camera, const ViewVolume& view,
                                                  const Eigen::Matrix4f& shadow, int size) {
  const Shadows none{no_shadows_.texture(), {}, size};
  if (size == 0) return none;
  // A surface looks up to kNormalOffset_m and some texels beside its own place.
  const double texel_m = 2.0 / (size * shadow.cast<double>().row(0).head<3>().norm());
  const double slack_m = kNormalOffset_m + (options_.shadow_taps > 1 ? 4.0 : 2.0) * texel_m;
  const ShadowVolume volume(shadow, scene_.light.direction, slack_m);
  ShadowedGround ground(camera, kNear_m, shadow, slack_m);
  const Needed needed = [&](const Eigen::Vector3d& centre, double radius_m) {
    if (!options_.draw_everything && !volume.may_shade(view, centre, radius_m)) return false;
    ground.add(centre, radius_m);
    return true;
  };
  if (!choose_solids(needed) && !options_.draw_everything) return none;
  const bool coarse = size != options_.shadow_map_size;
  if (coarse && coarse_shadow_map_.size() == 0) coarse_shadow_map_.build(size);
  const ShadowMap& map = coarse ? coarse_shadow_map_ : shadow_map_;
  begin_pass(map.framebuffer(), size, size);
  glEnable(GL_DEPTH_CLAMP);
  glDisable(GL_CULL_FACE);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5F, 2.0F);
  glClear(GL_DEPTH_BUFFER_BIT);
  glUseProgram(depth_program_.get());
  set_uniform(depth_program_, "clip_from_world", shadow);
  draw_solids();
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_CLAMP);
  return {map.texture(), options_.draw_everything ? whole_image(camera) : ground.pixels(), size};
}

void Renderer::Implementation::draw_image(const ImageTarget& target, const PinholeCamera& camera,
                                          const ViewVolume& view, const Eigen::Matrix4f& shadow,
                                          const Shadows& shadows) {
  begin_pass(target.framebuffer(), camera.width, camera.height);
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CW);
  const auto display = [](float radiance) { return std::sqrt(radiance); };
  glClearColor(display(kHorizon.r), display(kHorizon.g), display(kHorizon.b), 1.0F);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, pattern_.get());
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, shadows.map.get());

  const Eigen::Matrix4f clip = clip_from_world(camera, kNear_m, kFar_m);
  const auto use = [&](const GlProgram& program) {
    glUseProgram(program.get());
    set_uniform(program, "clip_from_world", clip);
    set_uniform(program, "shadow_from_world", shadow);
    set_uniform(program, "shadow_map", 1);
    set_uniform(program, "to_light", Eigen::Vector3f(scene_.light.direction.cast<float>()));
    set_uniform(program, "sun", static_cast<float>(0.8 * scene_.light.intensity));
    set_uniform(program, "ambient", static_cast<float>(scene_.light.ambient));
    set_uniform(program, "eye", Eigen::Vector3f(camera.X_WC.translation().cast<float>()));
    set_uniform(program, "horizon", kHorizon);
    if (shadows.size > 0) set_uniform(program, "shadow_texel", 1.0F / static_cast<float>(shadows.size));
  };
  use(solid_program_);
  set_uniform(solid_program_, "normal_offset", static_cast<float>(kNormalOffset_m));
  const Needed visible = [&](const Eigen::Vector3d& centre, double radius_m) {
    return options_.draw_everything || view.may_contain(centre, radius_m);
  };
  (void)choose_solids(visible);
  draw_solids();
  draw_flats(use, visible, whole_image(camera), shadows.on_ground);
}

void Renderer::Implementation::draw_flats(const std::function<void(const GlProgram&)>& use, const Needed& visible,
                                          const PixelBox& image, const PixelBox& shadowed) {
  // The flat surfaces lie on the ground, and nothing lies below it. They are painted in order behind the solids and do
  // not write depths, so that surfaces at the same height do not flicker.
  glDepthMask(GL_FALSE);
  const auto begin = [&](const GlProgram& program) {
    use(program);
    set_uniform(program, "pattern", 0);
    set_uniform(program, "texture_scale", static_cast<float>(1.0 / kGroundTextureExtent_m));
    if (scene_.ground_gloss > 0.0) set_uniform(program, "gloss", static_cast<float>(scene_.ground_gloss));
  };
  const auto paint = [&](const GlProgram& program, const Flat& flat, const PixelBox& box) {
    if (box.empty()) return;
    glScissor(box.left, box.top, box.right - box.left, box.bottom - box.top);  // row 0 is the top row of the image
    set_uniform(program, "colour", flat.colour());
    set_uniform(program, "pattern_strength", flat.pattern_strength());
    flat.draw(visible);
  };
  // The ground fills most of the image. Where no body can shade it, shadows are not looked up.
  const Flat& ground = flats_.front();
  const GlProgram& other_program = shadowed.empty() ? lit_flat_program_ : flat_program_;
  glEnable(GL_SCISSOR_TEST);
  begin(lit_flat_program_);
  for (const PixelBox& box : around(shadowed, image)) paint(lit_flat_program_, ground, box);
  if (!shadowed.empty()) begin(flat_program_);
  paint(flat_program_, ground, shadowed);
  for (std::size_t i = 1; i < flats_.size(); ++i) paint(other_program, flats_[i], image);
  glDisable(GL_SCISSOR_TEST);
}

const std::vector<std::uint8_t>& Renderer::Implementation::draw(const ScenePoses& poses, const PinholeCamera& camera,
                                                                const ShadowRegion& region) {
  const ContextScope scope(context_);
  ImageTarget& target = targets_.of_size(camera.width, camera.height, options_.samples);
  place(poses);
  const int shadow_size = shadow_map_size(region);
  const Eigen::Matrix4f shadow = shadow_from_world(scene_.light.direction, region, std::max(shadow_size, 1));
  const ViewVolume view(camera, kNear_m);
  draw_image(target, camera, view, shadow, draw_shadow_map(camera, view, shadow, shadow_size));
  const std::vector<std::uint8_t>& rgb = target.read();
  check_gl("drawing");
  compiler_memory_.after_image();
  return rgb;
}

Renderer::Renderer(const Scene& scene, const RenderOptions& options)
    : implementation_(std::make_unique<Implementation>(scene, options)) {}
Renderer::~Renderer() = default;

const std::vector<std::uint8_t>& Renderer::draw(const ScenePoses& poses, const PinholeCamera& camera,
                                                const ShadowRegion& region) {
  return implementation_->draw(poses, camera, region);
}

}  // namespace constrictor
