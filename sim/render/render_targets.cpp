#include "sim/render/render_targets.hpp"

#include <array>
#include <cstring>
#include <stdexcept>
#include <string>

namespace constrictor {
namespace {

std::runtime_error no_framebuffer(int width, int height) {
  return std::runtime_error("renderer: OpenGL cannot make a framebuffer of " + std::to_string(width) + " x " +
                            std::to_string(height) + " pixels");
}

}  // namespace

void ShadowMap::build(int size_texels) {
  size_ = size_texels;
  const int size = size_texels > 0 ? size_texels : 1;
  texture_ = GlTexture::create();
  glBindTexture(GL_TEXTURE_2D, texture_.get());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, size, size, 0, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
  constexpr std::array<float, 4> kLit{1.0F, 1.0F, 1.0F, 1.0F};
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, kLit.data());
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  framebuffer_ = GlFramebuffer::create();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, texture_.get(), 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("renderer: OpenGL cannot make a shadow map of " + std::to_string(size) + " texels");
  glClearDepth(1.0);
  glClear(GL_DEPTH_BUFFER_BIT);
}

void ImageTarget::resize(int width, int height, int samples_wanted) {
  if (width == width_ && height == height_ && samples_wanted == samples_) return;
  width_ = width;
  height_ = height;
  samples_ = samples_wanted;
  const int samples = samples_ > 1 ? samples_ : 0;  // OpenGL's 0 means no multisampling
  colour_buffer_ = GlRenderbuffer::create();
  glBindRenderbuffer(GL_RENDERBUFFER, colour_buffer_.get());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width, height);
  depth_buffer_ = GlRenderbuffer::create();
  glBindRenderbuffer(GL_RENDERBUFFER, depth_buffer_.get());
  glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, width, height);
  draw_framebuffer_ = GlFramebuffer::create();
  glBindFramebuffer(GL_FRAMEBUFFER, draw_framebuffer_.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_buffer_.get());
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_buffer_.get());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) throw no_framebuffer(width, height);
  if (samples > 0) {
    resolve_buffer_ = GlRenderbuffer::create();
    glBindRenderbuffer(GL_RENDERBUFFER, resolve_buffer_.get());
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    resolve_framebuffer_ = GlFramebuffer::create();
    glBindFramebuffer(GL_FRAMEBUFFER, resolve_framebuffer_.get());
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, resolve_buffer_.get());
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) throw no_framebuffer(width, height);
  }
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  rgba_.resize(4 * pixels);
  rgb_.resize(3 * pixels);
}

const std::vector<std::uint8_t>& ImageTarget::read() {
  if (samples_ > 1) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, draw_framebuffer_.get());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, resolve_framebuffer_.get());
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, resolve_framebuffer_.get());
  }
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba_.data());
  // Copies of four bytes are much faster than copies of three. The next pixel overwrites the fourth byte.
  const std::size_t last = rgb_.size() / 3 - 1;
  for (std::size_t pixel = 0; pixel < last; ++pixel) std::memcpy(&rgb_[3 * pixel], &rgba_[4 * pixel], 4);
  std::memcpy(&rgb_[3 * last], &rgba_[4 * last], 3);
  return rgb_;
}

ImageTarget& ImageTargets::of_size(int width, int height, int samples) {
  if (!targets_[newest_].has_size(width, height)) newest_ = 1 - newest_;
  targets_[newest_].resize(width, height, samples);
  return targets_[newest_];
}

}  // namespace constrictor
