// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/staged_files.hpp>

#include <glidar/io/files/folder_lock.hpp>
#include <tests/support/error_text.hpp>
#include <tests/support/test_folder.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <barrier>
#include <fstream>
#include <sstream>
#include <thread>

namespace glidar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

void write_pair(const fs::path& cloud, const std::string& text) {
  StagedFiles files;
  for (const fs::path& path : {cloud, fs::path(cloud.string() + ".json")}) {
    AtomicFile& file = files.add(path);
    file.write(text);
    file.finish();
  }
  files.commit();
}

TEST(StagedFiles, FilesOfConcurrentWritersAreFromOneOfThem) {
  const testing::TestFolder folder;
  const fs::path cloud = folder / "a.pcd";
  constexpr int kRounds = 500;
  constexpr int kWriters = 3;
  int mixed = 0;
  std::barrier start(kWriters);
  std::barrier end(kWriters, [&]() noexcept {
    if (content(cloud) != content(cloud.string() + ".json")) ++mixed;
  });
  std::vector<std::jthread> writers;
  for (int writer = 0; writer < kWriters; ++writer) {
    writers.emplace_back([&, text = std::to_string(writer)] {
      for (int round = 0; round < kRounds; ++round) {
        start.arrive_and_wait();
        write_pair(cloud, text);
        end.arrive_and_wait();
      }
    });
  }
  writers.clear();
  EXPECT_EQ(mixed, 0);
  EXPECT_THAT(folder.names(), ElementsAre("a.pcd", "a.pcd.json"));
}

TEST(StagedFiles, ProtectedFilesAreNotOverwritten) {
  const testing::TestFolder folder;
  const std::vector<std::string> read = {folder.write("q.pcd.json", "mine")};
  StagedFiles files;
  files.protect(read);
  files.add(folder / "q.pcd").finish();
  EXPECT_THAT(error_text([&] { files.add(folder / "q.pcd.json"); }), HasSubstr("is an input file"));
  files.clear();
  EXPECT_THAT(folder.names(), ElementsAre("q.pcd.json"));
  EXPECT_EQ(content(folder / "q.pcd.json"), "mine");
}

TEST(StagedFiles, ASignalRemovesNewFoldersAndKeepsOthers) {
  const testing::TestFolder folder;
  fs::create_directory(folder / "old");
  StagedFiles done;
  done.add_folder(folder / "done");
  done.commit();
  StagedFiles files;
  for (const char* name : {"old", "new", "new/part", "new/part/deep"})
    files.add_folder(folder / name);
  files.add(folder / "new/part/deep/a").write("text");
  remove_unfinished_files();  // what the signal handler calls
  EXPECT_THAT(folder.names(), ElementsAre("done", "old"));
}

TEST(FolderLock, ExcludesOthersDuringItsLifetimeAndLeavesNoFile) {
  const testing::TestFolder folder;
  std::optional<FolderLock> first(std::in_place, folder.path());
  EXPECT_TRUE(first->is_held());
  std::atomic<bool> is_free = false;
  std::jthread other([&] {
    const FolderLock second(folder.path());
    EXPECT_TRUE(second.is_held());
    EXPECT_TRUE(is_free);
  });
  is_free = true;
  first.reset();
  other.join();
  EXPECT_THAT(folder.names(), ElementsAre());
}

TEST(FolderLock, OfARunRefusesASecondRunAtOnce) {
  const testing::TestFolder folder;
  {
    const FolderLock first = FolderLock::of_run(folder.path());
    EXPECT_TRUE(first.is_held());
    EXPECT_THAT(error_text([&] { (void)FolderLock::of_run(folder.path()); }),
                HasSubstr("another run writes to this folder now; wait until it has ended"));
    StagedFiles files;
    files.set_locked();
    files.add(folder / "a").finish();
    files.add(folder / "b").finish();
    files.commit();  // does not wait for the lock of its own run
  }
  EXPECT_TRUE(FolderLock::of_run(folder.path()).is_held());
  EXPECT_FALSE(FolderLock::of_run("/nonexistent/folder").is_held());
}

TEST(FolderLock, AFolderThatCannotBeOpenedIsNotLocked) {
  EXPECT_FALSE(FolderLock("/nonexistent/folder").is_held());
}

}  // namespace
}  // namespace glidar
