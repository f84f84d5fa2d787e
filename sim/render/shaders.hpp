// Shader sources. They use arithmetic and square roots only: the last bits of pow, exp and trigonometric functions may
// depend on the CPU in a software renderer.
#pragma once

#include <string>

namespace constrictor {
namespace shaders {

/// Instanced solids. Rows 0 to 2 are the 3x4 matrix X_WInstance.
inline constexpr const char* kSolidVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in float shade;
layout(location = 3) in vec4 row0;
layout(location = 4) in vec4 row1;
layout(location = 5) in vec4 row2;
layout(location = 6) in vec3 scale;
layout(location = 7) in vec4 colour;      // reflectance, gloss
uniform mat4 clip_from_world;
uniform mat4 shadow_from_world;
uniform float normal_offset;              // [m] moves the shadow lookup off the surface
out vec3 world;
out vec3 world_normal;
out vec3 shadow_position;
out vec4 surface;
void main() {
  vec4 local = vec4(position * scale, 1.0);
  world = vec3(dot(row0, local), dot(row1, local), dot(row2, local));
  vec3 n = normal / scale;
  world_normal = vec3(dot(row0.xyz, n), dot(row1.xyz, n), dot(row2.xyz, n));
  vec3 unit = world_normal / sqrt(dot(world_normal, world_normal));
  shadow_position = (shadow_from_world * vec4(world + normal_offset * unit, 1.0)).xyz * 0.5 + 0.5;
  surface = vec4(colour.rgb * shade, colour.a);
  gl_Position = clip_from_world * vec4(world, 1.0);
}
)";

/// Ground, zones and line, which all lie on z = 0.
inline constexpr const char* kFlatVertex = R"(#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 clip_from_world;
uniform mat4 shadow_from_world;
uniform float texture_scale;              // [1/m]
out vec3 world;
out vec3 shadow_position;
out vec2 texture_position;
void main() {
  world = position;
  texture_position = position.xy * texture_scale;
  shadow_position = (shadow_from_world * vec4(position, 1.0)).xyz * 0.5 + 0.5;
  gl_Position = clip_from_world * vec4(position, 1.0);
}
)";

inline constexpr const char* kDepthFragment = R"(#version 330 core
void main() {}
)";

/// Code for both kinds of surface. `shadow_taps` is 1 (one bilinear comparison), 3 (3 x 3 comparisons), or 0 for places
/// where no body is drawn into the shadow map: it has its greatest depth there, so that the comparison needs no map.
inline std::string lighting(int shadow_taps) {
  return "#version 330 core\n#define TAPS " + std::to_string(shadow_taps) + R"(
uniform sampler2DShadow shadow_map;
uniform vec3 to_light;
uniform float sun;                        // irradiance of a surface that faces the light
uniform float ambient;
uniform vec3 eye;
uniform vec3 horizon;
uniform float shadow_texel;
in vec3 world;
in vec3 shadow_position;
out vec4 pixel;
float lit() {
#if TAPS == 0
  return shadow_position.z > 1.0 ? 0.0 : 1.0;
#elif TAPS == 1
  return texture(shadow_map, shadow_position);
#else
  float sum = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      sum += texture(shadow_map, shadow_position + vec3(float(x), float(y), 0.0) * (1.5 * shadow_texel));
  return sum / 9.0;
#endif
}
// Distant surfaces fade towards the colour of the horizon. The square root is the gamma of the display.
vec4 finish(vec3 radiance) {
  vec3 ray = world - eye;
  float distance2 = dot(ray, ray);
  vec3 seen = mix(radiance, horizon, distance2 / (distance2 + 3000.0));
  return vec4(sqrt(clamp(seen, 0.0, 1.0)), 1.0);
}
)";
}

inline constexpr const char* kSolidFragment = R"(
in vec3 world_normal;
in vec4 surface;
void main() {
  vec3 n = world_normal / sqrt(dot(world_normal, world_normal));
  float facing = dot(n, to_light);
  float light = lit() * clamp(facing * 8.0, 0.0, 1.0);
  float sky = 0.8 + 0.2 * n.z;
  vec3 view = eye - world;
  vec3 between = to_light + view / sqrt(dot(view, view));
  float gleam = max(dot(n, between), 0.0);
  float gleam2 = gleam * gleam / dot(between, between);   // cosine squared
  float gleam4 = gleam2 * gleam2;
  float gleam16 = gleam4 * gleam4 * gleam4 * gleam4;
  float specular = surface.a * gleam16 * gleam16 * light * sun;
  pixel = finish(surface.rgb * (ambient * sky + sun * max(facing, 0.0) * light) + vec3(specular));
}
)";

/// Flat surfaces. `glossy`: with a reflection of the light, of the strength `gloss`. The lobe is that of Blinn and
/// Phong with the exponent 64, normalised so that it reflects the same energy as a mirror; Schlick's approximation of
/// Fresnel's equations gives the share of the light, from 0.04 (a dielectric, seen from above) to 1 (at grazing
/// angles). `sun` is the irradiance divided by pi, as a matt surface reflects it.
inline std::string flat_fragment(bool glossy) {
  return std::string(R"(
uniform sampler2D pattern;
uniform vec3 colour;
uniform float pattern_strength;
in vec2 texture_position;
)") + (glossy ? R"(
uniform float gloss;
float glare() {
  vec3 view = eye - world;
  vec3 between = to_light + view / sqrt(dot(view, view));
  float length2 = dot(between, between);
  float cosine = sqrt(length2) * 0.5;                     // of the angle of incidence on a facet that mirrors the light
  float lobe2 = between.z * between.z / length2;          // squared cosine of the slope of this facet
  float lobe8 = lobe2 * lobe2 * lobe2 * lobe2;
  float lobe16 = lobe8 * lobe8;
  float lobe64 = lobe16 * lobe16 * lobe16 * lobe16;
  float grazing = max(1.0 - cosine, 0.0);
  float grazing2 = grazing * grazing;
  float fresnel = 0.04 + 0.96 * grazing2 * grazing2 * grazing;
  return gloss * sun * max(to_light.z, 0.0) * ((64.0 + 8.0) / 8.0) * lobe64 * fresnel;
}
void main() {
  float brightness = mix(1.0, texture(pattern, texture_position).r * (255.0 / 200.0), pattern_strength);
  float light = lit();
  vec3 matt = colour * brightness * (ambient + sun * max(to_light.z, 0.0) * light);
  pixel = finish(matt + vec3(glare() * light));
}
)"
              : R"(
void main() {
  float brightness = mix(1.0, texture(pattern, texture_position).r * (255.0 / 200.0), pattern_strength);
  pixel = finish(colour * brightness * (ambient + sun * max(to_light.z, 0.0) * lit()));
}
)");
}

}  // namespace shaders
}  // namespace constrictor
