// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/atomic_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/unique_fd.hpp>

#include <io/cloud_fixture.hpp>
#include <support/error_text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
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
}  // namespace glidar
