// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// How the import process opens and reads files.
#include <import/model_files.hpp>
#include <import/open_beneath.hpp>

#include <glidar/io/files/content_hash.hpp>

#include <support/test_folder.hpp>

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <cerrno>
#include <fstream>

namespace glidar::import {
namespace {

namespace fs = std::filesystem;
using glidar::testing::TestFolder;

std::string hash_of(const std::string& text) {
  ContentHash hash;
  hash.add(text.data(), text.size());
  return hex(hash.value());
}

class OpenBeneath : public ::testing::Test {
 protected:
  OpenBeneath() {
    folder_.write("root/sub/inside", "inside");
    folder_.write("elsewhere/inside", "secret");
    root_ = folder_ / "root";
    root_fd_ = open_root(root_);
  }
  UniqueFd open(const fs::path& path) const { return open_beneath(root_fd_.get(), root_, path); }

  TestFolder folder_;
  fs::path root_;
  UniqueFd root_fd_;
};

TEST_F(OpenBeneath, FilesInTheRootAreOpened) {
  EXPECT_TRUE(open(root_ / "sub/inside"));
}

TEST_F(OpenBeneath, FilesOutsideTheRootAreNotOpened) {
  EXPECT_FALSE(open(folder_ / "elsewhere/inside"));
  EXPECT_FALSE(open("/etc/passwd"));
  EXPECT_FALSE(open(root_ / "../elsewhere/inside"));
}

TEST_F(OpenBeneath, AFileReplacedByALinkIsNotOpened) {
  fs::remove(root_ / "sub/inside");
  fs::create_symlink(folder_ / "elsewhere/inside", root_ / "sub/inside");
  EXPECT_FALSE(open(root_ / "sub/inside"));
  EXPECT_EQ(errno, ELOOP);
}

TEST_F(OpenBeneath, AFolderReplacedByALinkIsNotEntered) {
  fs::rename(root_ / "sub", root_ / "old");
  fs::create_symlink(folder_ / "elsewhere", root_ / "sub");
  const UniqueFd opened = open(root_ / "sub/inside");
  if (errno == ENOSYS) GTEST_SKIP() << "no openat2; use Linux 5.6 or later";
  EXPECT_FALSE(opened);
}

class ModelFilesTest : public ::testing::Test {
 protected:
  ModelFilesTest() { file_ = folder_.write("a.obj", text_); }
  void append(const std::string& more) const { std::ofstream(file_, std::ios::app) << more; }

  TestFolder folder_;
  std::string text_ = "what the importer parses";
  fs::path file_;
  ModelFiles files_{{folder_.path(), folder_.path(), {}}};
};

TEST_F(ModelFilesTest, TheHashIsThatOfTheParsedBytes) {
  const auto content = files_.content(file_.string());
  ASSERT_NE(content, nullptr);
  EXPECT_EQ(content->whole(), text_);
  std::ofstream(file_) << "WHAT comes later";
  EXPECT_EQ(files_.content(file_.string())->whole(), text_);
  EXPECT_EQ(files_.hashes(), std::vector<std::string>{hash_of(text_)});
}

TEST_F(ModelFilesTest, AGrowingFileKeepsTheHashOfItsBeginning) {
  const auto content = files_.content(file_.string());
  EXPECT_EQ(content->head(4), "what");
  append(" and more");
  EXPECT_EQ(content->size(), text_.size());
  EXPECT_EQ(files_.hashes().at(0), hash_of(text_));
}

TEST_F(ModelFilesTest, AFileThatShrinksEndsEarly) {
  const auto content = files_.content(file_.string());
  EXPECT_EQ(content->head(4), "what");
  fs::resize_file(file_, 6);
  EXPECT_EQ(content->whole(), "what t");
  EXPECT_EQ(files_.hashes().at(0), hash_of("what t"));
}

TEST_F(ModelFilesTest, AReleasedFileKeepsItsHash) {
  files_.content(file_.string());
  files_.release(file_.string());
  append("changed");
  EXPECT_EQ(files_.hashes().at(0), hash_of(text_));
  EXPECT_EQ(files_.content(file_.string()), nullptr);
}

TEST_F(ModelFilesTest, AReplacementDoesNotChangeTheHash) {
  files_.replace(file_.string(), "decoded");
  ASSERT_NE(files_.replacement(file_.string()), nullptr);
  EXPECT_EQ(*files_.replacement(file_.string()), "decoded");
  files_.content(file_.string());
  EXPECT_EQ(files_.hashes().at(0), hash_of(text_));
}

TEST_F(ModelFilesTest, PipesAndFoldersAreNotFiles) {
  const std::string pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), S_IRWXU), 0);
  EXPECT_EQ(files_.content(pipe), nullptr);
  EXPECT_EQ(files_.content(folder_.path().string()), nullptr);
  EXPECT_TRUE(files_.paths().empty());
}

}  // namespace
}  // namespace glidar::import
