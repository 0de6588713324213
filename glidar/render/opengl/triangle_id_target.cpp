// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/triangle_id_target.hpp>

#include <glidar/core/error.hpp>

#include <algorithm>
#include <bit>

namespace glidar::opengl {
namespace {

GLsizei signed_size(std::uint32_t size) {
  return static_cast<GLsizei>(size);
}

}  // namespace

bool TriangleIdTarget::has_room(const TileSize& size) const {
  return size.rows <= room_.rows && size.cols <= room_.cols && size.count <= room_.count;
}

void TriangleIdTarget::make_room(const TileSize& size) {
  room_ = size;
  glBindTexture(GL_TEXTURE_2D_ARRAY, triangle_ids_.name());
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R32UI, signed_size(size.cols), signed_size(size.rows),
               signed_size(size.count), 0, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
  glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
  glBindRenderbuffer(GL_RENDERBUFFER, depths_.name());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, signed_size(size.cols),
                        signed_size(size.rows));
  framebuffers_.resize(std::max<std::size_t>(framebuffers_.size(), size.count));
  for (std::uint32_t i = 0; i < size.count; ++i) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffers_[i].name());
    glFramebufferTextureLayer(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, triangle_ids_.name(), 0,
                              signed_size(i));
    glFramebufferRenderbuffer(GL_DRAW_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                              depths_.name());
  }
  check_gl("allocating a framebuffer");
  if (glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw Error({.where = "OpenGL",
                 .found = "the driver cannot draw into 32-bit integer textures",
                 .allowed = "",
                 .remedy = "update the driver, or use --renderer rays"});
  }
}

void TriangleIdTarget::begin(const TileSize& size) {
  if (is_mapped_) end_reading();  // the last cast was aborted
  size_ = size;
  if (!has_room(size)) make_room(size);
  const auto bytes = static_cast<GLsizeiptr>(sizeof(std::uint32_t) * size.pixels() * size.count);
  if (bytes <= read_bytes_) return;
  read_bytes_ = bytes;
  glBindBuffer(GL_PIXEL_PACK_BUFFER, read_.name());
  glBufferData(GL_PIXEL_PACK_BUFFER, bytes, nullptr, GL_STREAM_READ);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  check_gl("allocating a framebuffer");
}

void TriangleIdTarget::draw_into(std::uint32_t tile) {
  constexpr GLuint kEmptyPixel = kNoTriangleId;
  constexpr GLfloat kFarthest = 0.0F;
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffers_[tile].name());
  glViewport(0, 0, signed_size(size_.cols), signed_size(size_.rows));
  glClearBufferuiv(GL_COLOR, 0, &kEmptyPixel);
  glClearBufferfv(GL_DEPTH, 0, &kFarthest);
}

void TriangleIdTarget::start_reading() {
  glBindBuffer(GL_PIXEL_PACK_BUFFER, read_.name());
  for (std::size_t i = 0; i < size_.count; ++i) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffers_[i].name());
    glReadPixels(0, 0, signed_size(size_.cols), signed_size(size_.rows), GL_RED_INTEGER,
                 GL_UNSIGNED_INT, std::bit_cast<void*>(sizeof(std::uint32_t) * size_.pixels() * i));
  }
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glFlush();
}

std::span<const std::uint32_t> TriangleIdTarget::triangle_ids() {
  const std::size_t count = size_.pixels() * size_.count;
  glBindBuffer(GL_PIXEL_PACK_BUFFER, read_.name());
  const void* start =
      glMapBufferRange(GL_PIXEL_PACK_BUFFER, 0,
                       static_cast<GLsizeiptr>(count * sizeof(std::uint32_t)), GL_MAP_READ_BIT);
  is_mapped_ = start != nullptr;
  check_not_lost();
  check_gl("reading a framebuffer");
  return {static_cast<const std::uint32_t*>(start), count};
}

void TriangleIdTarget::end_reading() {
  glBindBuffer(GL_PIXEL_PACK_BUFFER, read_.name());
  glUnmapBuffer(GL_PIXEL_PACK_BUFFER);
  is_mapped_ = false;
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
}

}  // namespace glidar::opengl
