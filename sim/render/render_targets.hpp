// Framebuffers that the renderer draws into. All functions need a current context.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/render/gl_handles.hpp"

namespace constrictor {

/// A square depth texture as seen from the light.
class ShadowMap {
 public:
  /// `size_texels` 0: no shadows; the texture then has one texel that is never drawn into and means "lit everywhere".
  void build(int size_texels);
  [[nodiscard]] int size() const { return size_; }  ///< [texel]; 0: not built, or without shadows
  [[nodiscard]] const GlTexture& texture() const { return texture_; }
  [[nodiscard]] const GlFramebuffer& framebuffer() const { return framebuffer_; }

 private:
  int size_ = 0;
  GlTexture texture_;
  GlFramebuffer framebuffer_;
};

/// The colour and depth buffers of an image, with or without multisampling.
class ImageTarget {
 public:
  /// Makes the buffers again if the size has changed. `samples` is 1 or 4.
  void resize(int width, int height, int samples);
  [[nodiscard]] bool has_size(int width, int height) const { return width == width_ && height == height_; }
  [[nodiscard]] const GlFramebuffer& framebuffer() const { return draw_framebuffer_; }
  /// Copies the image to memory: RGB8 rows from the top, valid until the next call.
  const std::vector<std::uint8_t>& read();

 private:
  GlFramebuffer draw_framebuffer_, resolve_framebuffer_;
  GlRenderbuffer colour_buffer_, depth_buffer_, resolve_buffer_;
  int width_ = 0;
  int height_ = 0;
  int samples_ = 1;
  std::vector<std::uint8_t> rgba_, rgb_;
};

/// Buffers for images of two sizes, as a picture and its close-up have.
class ImageTargets {
 public:
  /// Makes the buffers for this size if they are missing, and gives up those of the size before last.
  ImageTarget& of_size(int width, int height, int samples);

 private:
  std::array<ImageTarget, 2> targets_;
  std::size_t newest_ = 0;
};

}  // namespace constrictor
