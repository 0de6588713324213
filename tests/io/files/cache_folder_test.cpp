// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/cache_folder.hpp>

#include <io/model_cache_fixture.hpp>

#include <gmock/gmock.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <chrono>
#include <fstream>

namespace glidar {
namespace {

using ::testing::HasSubstr;
using testing::report_of;
using testing::Variable;
namespace fs = std::filesystem;

using CacheFolderOfModels = testing::ModelCacheTest;

TEST_F(CacheFolderOfModels, TheFolderAndItsFilesAreForTheirOwnerOnly) {
  options_.cache_folder = cache_.path() / "new" / "models";
  const mode_t before = ::umask(0);
  load();
  ::umask(before);
  for (const fs::path& folder : {options_.cache_folder, options_.cache_folder.parent_path()}) {
    EXPECT_EQ(fs::status(folder).permissions(), fs::perms::owner_all) << folder;
  }
  EXPECT_EQ(fs::status(cache_file()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(CacheFolderOfModels, AFolderThatOtherUsersCanAccessIsNotUsed) {
  load();
  for (const fs::perms others : {fs::perms::group_read, fs::perms::others_write}) {
    fs::permissions(options_.cache_folder, fs::perms::owner_all | others);
    EXPECT_FALSE(load().from_cache);
    EXPECT_THAT(report_of(file_, options_),
                ::testing::AllOf(HasSubstr("warning: the cache folder"),
                                 HasSubstr("accessible to other users (mode 07"),
                                 HasSubstr("chmod 700 '" + options_.cache_folder.string() + "'")));
  }
  fs::permissions(options_.cache_folder, fs::perms::owner_all);
  EXPECT_TRUE(load().from_cache);
}

TEST_F(CacheFolderOfModels, AFolderOfAnotherUserIsNotUsed) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can give a folder away; run it as root";
  load();
  ASSERT_EQ(::chown(options_.cache_folder.c_str(), 12345, 0), 0);
  EXPECT_FALSE(load().from_cache);
  EXPECT_THAT(report_of(file_, options_),
              ::testing::AllOf(HasSubstr("belongs to another user (id 12345)"),
                               HasSubstr("--cache-folder"), HasSubstr("--no-cache")));
}

TEST_F(CacheFolderOfModels, AnEntryThatOthersCanWriteIsNotRead) {
  load();
  fs::permissions(cache_file(), fs::perms::group_write, fs::perm_options::add);
  EXPECT_FALSE(load().from_cache);
  EXPECT_TRUE(load().from_cache);  // it was replaced
  const fs::path elsewhere = cache_.path() / "elsewhere";
  fs::rename(cache_file(), elsewhere);
  fs::create_symlink(elsewhere, options_.cache_folder / fs::path(entry_name()));
  EXPECT_FALSE(load().from_cache);
}

/// Entries of a mebibyte each, the first used longest ago.
class FullModelCache : public testing::ModelCacheTest {
 protected:
  fs::path fill(char key, int hours_ago) {
    const std::string name = std::string(32, key) + ".model";
    fs::create_directories(options_.cache_folder);
    fs::permissions(options_.cache_folder, fs::perms::owner_all);
    const fs::path file = options_.cache_folder / name;
    std::ofstream(file) << std::string(std::size_t{1} << 20U, 'x');
    fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::hours(hours_ago));
    return file;
  }
};

TEST_F(FullModelCache, TheLeastRecentlyUsedEntriesAreEvicted) {
  const Variable limit("GLIDAR_CACHE_LIMIT_MIB", "3");
  const fs::path oldest = fill('a', 30);
  const fs::path older = fill('b', 20);
  const fs::path old = fill('c', 10);
  load();
  EXPECT_FALSE(fs::exists(oldest));
  EXPECT_TRUE(fs::exists(older));
  EXPECT_TRUE(fs::exists(old));
  const fs::path own = options_.cache_folder / entry_name();
  fs::last_write_time(own, fs::file_time_type::clock::now() - std::chrono::hours(40));
  EXPECT_TRUE(load().from_cache);  // which counts as use
  fill('d', 1);
  testing::load(temp_.write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), options_);
  EXPECT_FALSE(fs::exists(older));
  EXPECT_TRUE(load().from_cache);
}

TEST_F(FullModelCache, OtherFilesInTheFolderAreKept) {
  const Variable limit("GLIDAR_CACHE_LIMIT_MIB", "1");
  const fs::path entry = fill('a', 30);
  const fs::path notes = options_.cache_folder / "notes.model";
  std::ofstream(notes) << std::string(std::size_t{3} << 20U, 'x');
  load();
  EXPECT_FALSE(fs::exists(entry));
  EXPECT_TRUE(fs::exists(notes));
}

TEST_F(FullModelCache, AModelLargerThanTheLimitIsNotStored) {
  const Variable limit("GLIDAR_CACHE_LIMIT_MIB", "0");
  EXPECT_THAT(report_of(file_, options_),
              HasSubstr("the model is not cached: it takes 1 MiB, the limit of all is 0 MiB "
                        "(GLIDAR_CACHE_LIMIT_MIB)"));
  EXPECT_EQ(cache_files(), 0U);
}

TEST_F(FullModelCache, ALimitThatIsNotANumberIsRejected) {
  for (const char* wrong : {"2G", "-1", "1.5", "99999999999999999999"}) {
    const Variable limit("GLIDAR_CACHE_LIMIT_MIB", wrong);
    EXPECT_THAT(testing::load_error(file_.string(), options_),
                ::testing::AllOf(HasSubstr("GLIDAR_CACHE_LIMIT_MIB"), HasSubstr(wrong),
                                 HasSubstr("a whole number of MiB")));
  }
}

TEST_F(FullModelCache, TemporaryFilesOfDeadWritersAreRemoved) {
  const std::string entry = fill('a', 1).string();
  std::ofstream(entry + ".0123456789abcdef") << "half";
  std::ofstream(entry + ".oldxyz") << "half";
  const std::string living = entry + ".fedcba9876543210";
  std::ofstream(living) << "half";
  const UniqueFd writer(::open(living.c_str(), O_RDONLY | O_CLOEXEC));
  ASSERT_EQ(::flock(writer.get(), LOCK_EX), 0);
  load();
  EXPECT_FALSE(fs::exists(entry + ".0123456789abcdef"));
  EXPECT_FALSE(fs::exists(entry + ".oldxyz"));
  EXPECT_TRUE(fs::exists(living));
  EXPECT_EQ(cache_files(), 3U);
}

}  // namespace
}  // namespace glidar
