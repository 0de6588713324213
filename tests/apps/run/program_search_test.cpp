// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/program_search.hpp>

#include <tests/support/test_folder.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace glidar::app {
namespace {

namespace fs = std::filesystem;
using Folders = std::vector<fs::path>;

TEST(ProgramSearch, EmptyAndRelativeFoldersAreLeftOut) {
  EXPECT_EQ(absolute_folders(":/a:.:b:./c:/d/e::../f:/g:"), (Folders{"/a", "/d/e", "/g"}));
  EXPECT_EQ(absolute_folders(""), Folders{});
  EXPECT_EQ(absolute_folders(":"), Folders{});
  EXPECT_EQ(joined_folders({"/a", "/b"}), "/a:/b");
  EXPECT_EQ(joined_folders({}), "");
}

TEST(ProgramSearch, OnlyExecutableFilesAreFoundInTheOrderOfFolders) {
  const testing::TestFolder folder;
  const fs::path& root = folder.path();
  for (const char* name : {"a", "b", "c", "d"}) fs::create_directory(root / name);
  for (const char* name : {"a", "c", "d"}) std::ofstream(root / name / "tool") << "#!/bin/sh\n";
  fs::create_directory(root / "b" / "tool");
  for (const char* name : {"a", "d"})
    fs::permissions(root / name / "tool", fs::perms::owner_all, fs::perm_options::add);
  const Folders found = find_programs("tool", {root / "d", root / "b", root / "c", root / "a"});
  EXPECT_EQ(found, (Folders{root / "d" / "tool", root / "a" / "tool"}));
  EXPECT_EQ(find_programs("none", {root / "a"}), Folders{});
}

}  // namespace
}  // namespace glidar::app
