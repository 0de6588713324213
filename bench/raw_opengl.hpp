// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model/model.hpp>
#include <glidar/render/opengl/egl_context.hpp>
#include <glidar/render/opengl/gl_object.hpp>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace glidar::bench {

constexpr double kFov_rad = 0.35;

/// A model and a position from which it fills the image. Meshes must be near their origin in single
/// precision, as the Stanford models are.
struct Model {
  std::string name;
  Scene scene;
  Pose world_from_sensor;

  Model(std::string model_name, const std::string& path);
};

/// The Stanford models in the folder that GLIDAR_DATA names, otherwise a generated model.
std::vector<std::unique_ptr<Model>> models();

/// The device that GLIDAR_GRAPHICS_DEVICE names by its index; empty: the first with a context.
std::optional<std::uint32_t> chosen_device();

/// Range of depths around a model.
std::pair<double, double> planes_around(const Model& model);

/// The standard perspective of OpenGL, rows downwards.
Eigen::Matrix4f clip_matrix(const Model& model, double near_m, double far_m);

/// Content of a baseline's pixels, and their format.
struct Raw {
  const char* vertex;
  const char* fragment;
  GLenum stored;
  GLenum format;
  GLenum type;
};

/// The id of each triangle.
extern const Raw kRawNumbers;
/// The shaders of the quantized framebuffer, reduced to untextured models.
extern const Raw kRawFramebuffer;

/// Compiles one stage after the other and links.
void compile(const opengl::Program& program,
             std::initializer_list<std::pair<GLenum, const char*>> stages);

/// The baseline: OpenGL alone. It draws the triangles in the order of their file into a square
/// image with a float depth, and reads the image.
class RawOpengl {
 public:
  RawOpengl(const Model& model, const Raw& raw, std::uint32_t side);

  /// Of the perspective and of kRawFramebuffer's depths; at first they are around the model.
  void set_planes(double near_m, double far_m);
  void draw();
  void draw_and_read();
  [[nodiscard]] const std::vector<std::uint32_t>& pixels() const { return pixels_; }

 private:
  struct Objects {
    opengl::VertexArray arrays;
    opengl::Buffer positions;
    opengl::Buffer normals;
    opengl::Buffer triangles;
    opengl::Framebuffer frame;
    opengl::Renderbuffer colours;
    opengl::Renderbuffer depths;
    opengl::Program program;
  };

  void make_targets();

  const Model& model_;
  opengl::EglContext context_;
  opengl::ScopedContext use_;
  const Raw& raw_;
  GLsizei side_;
  GLsizei count_;
  std::vector<std::uint32_t> pixels_;
  std::unique_ptr<Objects> objects_;
};

}  // namespace glidar::bench
