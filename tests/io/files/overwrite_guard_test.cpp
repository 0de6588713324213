// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/overwrite_guard.hpp>

#include <glidar/core/error.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

namespace glidar {
namespace {

class FileGuard : public ::testing::Test {
 protected:
  FileGuard() {
    std::string name = std::filesystem::temp_directory_path() / "glidar-guard-XXXXXX";
    folder = mkdtemp(name.data());
    std::ofstream(folder / "a.ply") << "ply";
  }
  ~FileGuard() override { std::filesystem::remove_all(folder); }

  std::filesystem::path folder;
};

TEST_F(FileGuard, IdentifiesAFileByAllItsNames) {
  std::filesystem::create_symlink(folder / "a.ply", folder / "link.ply");
  std::filesystem::create_hard_link(folder / "a.ply", folder / "hard.ply");
  const std::vector<std::string> read = {folder / "a.ply"};
  for (const char* name : {"a.ply", "./a.ply", "link.ply", "hard.ply"}) {
    EXPECT_TRUE(is_same_file(folder / name, folder / "a.ply")) << name;
    EXPECT_THROW(refuse_overwrite_of_inputs(read, folder / name), Error) << name;
  }
  EXPECT_FALSE(is_same_file(folder / "b.ply", folder / "a.ply"));
}

TEST_F(FileGuard, IdentifiesAMissingFileByItsPath) {
  EXPECT_TRUE(is_same_file(folder / "x" / ".." / "new.ply", folder / "new.ply"));
  const std::vector<std::string> read = {folder / "a.ply"};
  EXPECT_NO_THROW(refuse_overwrite_of_inputs(read, folder / "new.ply"));
}

TEST_F(FileGuard, ResolvesDotDotAfterALinkLikeTheSystem) {
  std::filesystem::create_directories(folder / "real" / "sub");
  std::filesystem::create_directory_symlink(folder / "real" / "sub", folder / "link");
  EXPECT_TRUE(is_same_file(folder / "link" / ".." / "new.ply", folder / "real" / "new.ply"));
  EXPECT_FALSE(is_same_file(folder / "link" / ".." / "a.ply", folder / "a.ply"));
  const std::vector<std::string> read = {folder / "a.ply"};
  EXPECT_NO_THROW(refuse_overwrite_of_inputs(read, folder / "link" / ".." / "a.ply"));
}

TEST_F(FileGuard, ListsTheFilesOfAllModels) {
  Scene scene;
  scene.sources = {{.path = "a.obj", .hash = "", .files = {"a.obj", "a.mtl"}},
                   {.path = "b.ply", .hash = "", .files = {"b.ply"}}};
  EXPECT_EQ(files_of(scene), (std::vector<std::string>{"a.obj", "a.mtl", "b.ply"}));
}

}  // namespace
}  // namespace glidar
