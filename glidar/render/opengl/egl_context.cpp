// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/render/opengl/egl_context.hpp>

#include <glidar/core/error.hpp>

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <string_view>
#include <utility>

namespace glidar::opengl {

/// The thread's current context. EGL has one for OpenGL and OpenGL ES together, so this is also the
/// context of a window library.
struct Current {
  EGLDisplay display = eglGetCurrentDisplay();
  EGLContext context = eglGetCurrentContext();
  EGLSurface draw = eglGetCurrentSurface(EGL_DRAW);
  EGLSurface read = eglGetCurrentSurface(EGL_READ);
};

struct EglContext::Handles {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::optional<Current> before;  ///< while it is current
};

namespace {

constexpr const char* kInstall =
    "install a driver: libegl1, libopengl0 and, for drawing in software, libgl1-mesa-dri (Debian, "
    "Ubuntu); or use --renderer rays";

[[noreturn]] void fail(std::string found) {
  throw Error({.where = "OpenGL",
               .found = std::move(found),
               .allowed = "a context of OpenGL 3.3 or later, through EGL",
               .remedy = kInstall});
}

bool can_open(const char* library) {
  void* handle = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
  if (handle != nullptr) dlclose(handle);
  return handle != nullptr;
}

/// libepoxy terminates the program if a library is missing, so this is tested first.
bool has_libraries() {
  return can_open("libEGL.so.1") && (can_open("libOpenGL.so.0") || can_open("libGL.so.1"));
}

bool has_extension(const char* extensions, std::string_view wanted) {
  const std::string padded = " " + std::string(extensions == nullptr ? "" : extensions) + " ";
  return padded.find(" " + std::string(wanted) + " ") != std::string::npos;
}

std::vector<EGLDeviceEXT> devices() {
  constexpr EGLint kMax = 64;
  std::vector<EGLDeviceEXT> found(kMax);
  EGLint count = 0;
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const bool can_list = has_extension(extensions, "EGL_EXT_platform_device") &&
                        (has_extension(extensions, "EGL_EXT_device_enumeration") ||
                         has_extension(extensions, "EGL_EXT_device_base"));
  if (!can_list || eglQueryDevicesEXT(kMax, found.data(), &count) == EGL_FALSE) count = 0;
  found.resize(static_cast<std::size_t>(count));
  return found;
}

std::string describe(EGLDeviceEXT device) {
  const char* extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
  if (has_extension(extensions, "EGL_MESA_device_software")) return "drawing in software";
  if (has_extension(extensions, "EGL_EXT_device_drm")) {
    const char* file = eglQueryDeviceStringEXT(device, EGL_DRM_DEVICE_FILE_EXT);
    if (file != nullptr) return file;
  }
  return "a graphics device";
}

/// The display of a device; without a device, that of Mesa where EGL cannot list devices.
EGLDisplay display_of(EGLDeviceEXT device) {
  if (device != EGL_NO_DEVICE_EXT) {
    return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
  }
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (!has_extension(extensions, "EGL_MESA_platform_surfaceless")) return EGL_NO_DISPLAY;
  return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

/// A core context of this version; EGL_NO_CONTEXT if not supported. It reports
/// resets of the graphics device if the driver supports that.
EGLContext make_context_of_version(EGLDisplay display, EGLint major, EGLint minor) {
  const std::array<EGLint, 6> version = {
      EGL_CONTEXT_MAJOR_VERSION,       major,
      EGL_CONTEXT_MINOR_VERSION,       minor,
      EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
  std::vector<EGLint> attributes(version.begin(), version.end());
  attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                       EGL_LOSE_CONTEXT_ON_RESET, EGL_NONE});
  EGLContext context =
      eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
  if (context != EGL_NO_CONTEXT) return context;
  attributes.assign(version.begin(), version.end());
  attributes.push_back(EGL_NONE);
  return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
}

/// Some drivers return exactly the requested version, not the latest compatible one.
EGLContext make_context_of_api(EGLDisplay display) {
  for (const auto& [major, minor] : {std::pair{4, 5}, {4, 3}}) {
    EGLContext context = make_context_of_version(display, major, minor);
    if (context != EGL_NO_CONTEXT) return context;
  }
  return make_context_of_version(display, 3, 3);
}

/// A context without config and surface; EGL_NO_CONTEXT if not supported. A display stays
/// initialised, because EGL shares it within the process and others may use it.
EGLContext make_context(EGLDisplay display) {
  if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) == EGL_FALSE) {
    return EGL_NO_CONTEXT;
  }
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  if (!has_extension(extensions, "EGL_KHR_surfaceless_context") ||
      !(has_extension(extensions, "EGL_KHR_no_config_context") ||
        has_extension(extensions, "EGL_MESA_configless_context"))) {
    return EGL_NO_CONTEXT;
  }
  const EGLenum api_before = eglQueryAPI();
  EGLContext context = EGL_NO_CONTEXT;
  if (eglBindAPI(EGL_OPENGL_API) == EGL_TRUE) context = make_context_of_api(display);
  eglBindAPI(api_before);
  return context;
}

/// "0: /dev/dri/card0, 1: drawing in software".
std::string listed(const std::vector<std::string>& all) {
  std::string text;
  for (std::size_t i = 0; i < all.size(); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(i) + ": " + all[i];
  }
  return text;
}

/// The devices to try: the selected one, or all, or the default where none are listed.
std::vector<EGLDeviceEXT> candidates(std::optional<std::uint32_t> chosen) {
  std::vector<EGLDeviceEXT> all = devices();
  if (!chosen) return all.empty() ? std::vector<EGLDeviceEXT>{EGL_NO_DEVICE_EXT} : all;
  if (*chosen < all.size()) return {all[*chosen]};
  throw Error({.where = "graphics device",
               .found = std::to_string(*chosen),
               .allowed = all.empty() ? "none: there are no devices to choose from"
                                      : listed(graphics_devices()),
               .remedy = ""});
}

}  // namespace

std::vector<std::string> graphics_devices() {
  std::vector<std::string> all;
  if (!has_libraries()) return all;
  for (EGLDeviceEXT device : devices()) all.push_back(describe(device));
  return all;
}

EglContext::EglContext(std::optional<std::uint32_t> device)
    : handles_(std::make_unique<Handles>()) {
  if (!has_libraries()) fail("its libraries (libEGL.so.1, libOpenGL.so.0) are not there");
  for (EGLDeviceEXT candidate : candidates(device)) {
    handles_->display = display_of(candidate);
    handles_->context = make_context(handles_->display);
    if (handles_->context != EGL_NO_CONTEXT) return;
  }
  const std::vector<std::string> all = graphics_devices();
  fail(device ? "device " + std::to_string(*device) + " gives no context (devices: " + listed(all) +
                    ")"
       : all.empty() ? "there is no graphics device, not even one that draws in software"
                     : "no device gives a context (devices: " + listed(all) + ")");
}

EglContext::~EglContext() {
  if (handles_->context != EGL_NO_CONTEXT) eglDestroyContext(handles_->display, handles_->context);
}

void EglContext::make_current() {
  const Current before;
  if (eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, handles_->context) ==
      EGL_FALSE) {
    fail("the context cannot be made current in this thread");
  }
  handles_->before = before;
}

void EglContext::release() {
  const Current before = *std::exchange(handles_->before, std::nullopt);
  if (before.context == EGL_NO_CONTEXT) {
    eglMakeCurrent(handles_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  } else {
    eglMakeCurrent(before.display, before.draw, before.read, before.context);
  }
}

}  // namespace glidar::opengl
