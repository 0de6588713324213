// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/core/error.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/files/cache_folder.hpp>
#include <glidar/io/files/unique_fd.hpp>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <io/cloud_fixture.hpp>
#include <support/error_text.hpp>
#include <tests/support/error_text.hpp>
#include <tests/support/test_folder.hpp>

#include <barrier>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

namespace glidar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// No file may grow beyond this many bytes while it lives: a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    rlimit limit = before_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
  const testing::TestFolder folder;
  AtomicFile file(folder / "a.txt");
  file.write("whole");
  file.finish();
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
  file.commit();
  EXPECT_EQ(file_bytes(folder / "a.txt"), "whole");
  EXPECT_THAT(folder.names(), ElementsAre("a.txt"));
}

/// So many that files get a temporary name when they are finished.
class ManyDescriptors {
 public:
  ManyDescriptors() {
    for (int i = 0; i < 128; ++i) copies_.emplace_back(::fcntl(0, F_DUPFD_CLOEXEC, 3));
  }

 private:
  std::vector<UniqueFd> copies_;
};

TEST(AtomicFile, HasNoNameThatCouldStayUntilItIsCommitted) {
  const testing::TestFolder folder;
  if (!UniqueFd(::open(folder.path().c_str(), O_WRONLY | O_TMPFILE, 0600)))
    GTEST_SKIP() << "no files without names; use another file system";
  AtomicFile file(folder / "a.txt");
  file.write(std::string(1'000'000, 'a'));
  file.finish();
  EXPECT_THAT(folder.names(), IsEmpty());
  const ManyDescriptors many;
  AtomicFile other(folder / "b.txt");
  other.finish();
  EXPECT_EQ(folder.names().size(), 1U);  // its temporary name
  file.commit();
  other.commit();
  EXPECT_THAT(folder.names(), ElementsAre("a.txt", "b.txt"));
}

TEST(AtomicFile, WritesTheTargetOfASymbolicLink) {
  const testing::TestFolder folder;
  std::filesystem::create_directory(folder / "real");
  std::ofstream(folder / "real/old.txt") << "old";
  std::filesystem::create_symlink("real/old.txt", folder / "link");
  std::filesystem::create_symlink("link", folder / "chain");
  std::filesystem::create_symlink("real/new.txt", folder / "dangling");
  std::filesystem::create_symlink("loop", folder / "loop");
  for (const char* name : {"link", "chain", "dangling"}) {
    AtomicFile file(folder / name);
    file.write(name);
    file.commit();
    EXPECT_TRUE(std::filesystem::is_symlink(folder / name)) << name;
    EXPECT_EQ(file_bytes(folder / name), name);
  }
  EXPECT_EQ(file_bytes(folder / "real/old.txt"), "chain");
  EXPECT_EQ(file_bytes(folder / "real/new.txt"), "dangling");
  EXPECT_THAT(error_text([&] { AtomicFile file(folder / "loop"); }),
              HasSubstr("loop: cannot follow this symbolic link"));
}

TEST(AtomicFile, IsNotRenamedAfterAFailedClose) {
  const testing::TestFolder folder;
  AtomicFile file(folder / "a.txt");
  file.write("whole");
  file.seek(5);  // flushes
  for (int descriptor = 3; descriptor < 4096; ++descriptor) {
    std::error_code ignored;
    const auto own = std::filesystem::path("/proc/self/fd") / std::to_string(descriptor);
    const std::string name = std::filesystem::read_symlink(own, ignored);
    if (!ignored && name.starts_with(folder.path().string() + "/")) ::close(descriptor);
  }
  EXPECT_THROW(file.commit(), Error);
  EXPECT_THROW(file.commit(), Error);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
}

TEST(AtomicFile, LeavesTheOldFileWhenNotCommitted) {
  const testing::TestFolder folder;
  {
    AtomicFile file(folder / "a.txt");
    file.write("old");
    file.commit();
  }
  {
    AtomicFile file(folder / "a.txt");
    file.write("new");
  }
  EXPECT_EQ(file_bytes(folder / "a.txt"), "old");
  EXPECT_THAT(folder.names(), ElementsAre("a.txt"));
}

TEST(AtomicFile, KeepsTheOrderOfSmallAndLargeWrites) {
  const testing::TestFolder folder;
  const std::string large(1'000'000, 'b');
  AtomicFile file(folder / "a.txt");
  file.write("a");
  file.write(large);
  file.write("c");
  EXPECT_EQ(file.position(), large.size() + 2);
  file.seek(1);
  file.write("X");
  EXPECT_EQ(file.position(), 2U);
  file.commit();
  const std::string found = file_bytes(folder / "a.txt");
  EXPECT_EQ(found, "aX" + large.substr(1) + "c");
}

TEST(AtomicFile, ADurableCommitReplacesTheOldFileAndLeavesNoOtherFile) {
  const testing::TestFolder folder;
  for (const char* text : {"old", "new"}) {
    AtomicFile file(folder / "a.txt");
    file.write(text);
    file.commit_durably();
    EXPECT_EQ(file_bytes(folder / "a.txt"), text);
  }
  EXPECT_THAT(folder.names(), ElementsAre("a.txt"));
}

TEST(AtomicFile, ADurableCommitOnAFullDiskLeavesTheOldFile) {
  const testing::TestFolder folder;
  {
    AtomicFile file(folder / "a.txt");
    file.write("old");
    file.commit();
  }
  const FullDisk full(4096);
  EXPECT_THAT(error_text([&] {
                AtomicFile file(folder / "a.txt");
                file.write(std::string(100'000, 'x'));
                file.commit_durably();
              }),
              HasSubstr("File too large"));
  EXPECT_EQ(file_bytes(folder / "a.txt"), "old");
  EXPECT_THAT(folder.names(), ElementsAre("a.txt"));
}

TEST(AtomicFile, ReportsAFullDiskAndLeavesNoFile) {
  const testing::TestFolder folder;
  const FullDisk full(4096);
  const std::string text = error_text([&] {
    AtomicFile file(folder / "a.txt");
    file.write(std::string(100'000, 'x'));
    file.commit();
  });
  EXPECT_THAT(text, HasSubstr((folder / "a.txt").string()));
  EXPECT_THAT(text, HasSubstr("File too large"));
  EXPECT_THAT(text, HasSubstr("no part of this file remains"));
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(AtomicFile, ReportsAMissingOrUnwritableFolder) {
  const testing::TestFolder folder;
  EXPECT_THAT(error_text([&] { AtomicFile file(folder / "none/a.txt"); }),
              HasSubstr("No such file or directory; create the folder first"));
  EXPECT_THAT(error_text([&] { AtomicFile file("/proc/a.txt"); }),
              HasSubstr("/proc/a.txt: cannot create a file in this folder"));
  EXPECT_THAT(error_text([&] { AtomicFile file(folder.path()); }), HasSubstr("is a folder"));
}

TEST(AtomicFile, DoesNotReplacePipesAndDevices) {
  const testing::TestFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(error_text([&] { AtomicFile file(folder / "pipe"); }),
              HasSubstr("is a device, pipe or socket"));
  EXPECT_THAT(error_text([] { AtomicFile file("/dev/null"); }),
              HasSubstr("is a device, pipe or socket"));
}

TEST(AtomicFile, CanBePrivateToItsOwner) {
  const testing::TestFolder folder;
  AtomicFile file(folder / "key", AtomicFile::Permissions::owner_only);
  file.commit();
  struct stat about {};
  ASSERT_EQ(::stat((folder / "key").c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777U, 0600U);
}

TEST(AtomicFile, RespectsTheUmask) {
  const testing::TestFolder folder;
  const mode_t before = ::umask(0027);
  {
    AtomicFile file(folder / "a.txt");
    file.commit();
  }
  ::umask(before);
  EXPECT_EQ(std::filesystem::status(folder / "a.txt").permissions(), std::filesystem::perms(0640));
}

TEST(AtomicFile, ConcurrentWritersOfOneNameLeaveOneCompleteFile) {
  const testing::TestFolder folder;
  const auto write_often = [&](char letter) {
    for (int i = 0; i < 50; ++i) {
      AtomicFile file(folder / "a.txt");
      for (int part = 0; part < 10; ++part) file.write(std::string(10'000, letter));
      file.commit();
    }
  };
  std::thread other(write_often, 'b');
  write_often('a');
  other.join();
  const std::string found = file_bytes(folder / "a.txt");
  EXPECT_EQ(found, std::string(100'000, found.at(0)));
  EXPECT_THAT(folder.names(), ElementsAre("a.txt"));
}

TEST(AtomicFile, RemovesUnfinishedFilesForASignalHandler) {
  const testing::TestFolder folder;
  AtomicFile done(folder / "done.txt");
  done.commit();
  const ManyDescriptors many;
  AtomicFile first(folder / "first.txt");
  AtomicFile second(folder / "second.txt");
  first.finish();
  second.finish();
  EXPECT_EQ(folder.names().size(), 3U);
  remove_unfinished_files();
  EXPECT_THAT(folder.names(), ElementsAre("done.txt"));
  EXPECT_THROW(first.commit(), Error);
}

TEST(AtomicFile, ReusesSlotsOfClosedFiles) {
  const testing::TestFolder folder;
  for (int i = 0; i < 100; ++i) AtomicFile(folder / "a.txt").commit();
  AtomicFile file(folder / "b.txt");
  remove_unfinished_files();
  EXPECT_THAT(folder.names(), ElementsAre("a.txt"));
}

}  // namespace

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
