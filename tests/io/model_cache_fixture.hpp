// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/io/model/model_cache.hpp>

#include <io/model_test_support.hpp>

#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>

namespace glidar::testing {

/// A model with a material file and one texture found, one missing; and a cache folder.
class ModelCacheTest : public ::testing::Test {
 protected:
  ModelCacheTest() {
    options_.cache_folder = cache_.path() / "models";
    temp_.write("a.mtl", "newmtl paint\nmap_Kd paint.ppm\nmap_Ks shine.ppm\n");
    temp_.write("paint.ppm", ppm(1, 1, "abc"));
    file_ = temp_.write("a.obj", quad_obj("a.mtl"));
  }

  Model load() const { return testing::load(file_, options_); }
  std::filesystem::path cache_file() const {
    return std::filesystem::directory_iterator(options_.cache_folder)->path();
  }
  std::string entry_name() const { return cache_entry(file_, options_, {})->name; }
  std::size_t cache_files() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(options_.cache_folder), {}));
  }

  TestFolder temp_;
  TestFolder cache_;
  ModelOptions options_;
  std::filesystem::path file_;
};

/// The environment variable has this value while it lives.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    ::setenv(name, value.c_str(), 1);
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
  ~Variable() {
    if (old_) {
      ::setenv(name_, old_->c_str(), 1);
    } else {
      ::unsetenv(name_);
    }
  }

 private:
  const char* name_;
  std::optional<std::string> old_;
};

/// What loading reports.
inline std::string report_of(const std::filesystem::path& file, const ModelOptions& options) {
  std::string text;
  const Report report{[&text](Severity severity, std::string_view message) {
                        text += (severity == Severity::warning ? "warning: " : "info: ") +
                                std::string(message) + "\n";
                      },
                      {}};
  load_model(file.string(), options, report);
  return text;
}

}  // namespace glidar::testing
