// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/decoder/import_program.hpp>
#include <glidar/io/model/model_cache.hpp>

#include <glidar/io/files/content_hash.hpp>
#include <glidar/io/model/import_process.hpp>
#include <glidar/io/model/mesh_blob.hpp>

#include <io/model_cache_fixture.hpp>

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

namespace glidar {
namespace {

using ::testing::HasSubstr;
using testing::TestFolder;
using testing::Variable;
using ModelCache = testing::ModelCacheTest;
namespace fs = std::filesystem;

std::string bytes(const Model& model) {
  const TestFolder temp;
  const fs::path file = temp.write("blob", "");
  std::FILE* opened = std::fopen(file.c_str(), "wb");
  ImportedModel imported;
  imported.model = model;
  write_model(::fileno(opened), imported);
  std::fclose(opened);
  return testing::read_file(file);
}

TEST_F(ModelCache, TheSecondLoadGivesTheSameModel) {
  const Model first = load();
  const Model second = load();
  EXPECT_FALSE(first.from_cache);
  EXPECT_TRUE(second.from_cache);
  EXPECT_EQ(first.hash, second.hash);
  EXPECT_EQ(first.missing_textures.size(), second.missing_textures.size());
  EXPECT_EQ(bytes(first), bytes(second));
  EXPECT_EQ(cache_files(), 1U);
}

TEST_F(ModelCache, TheDisabledCacheIsNeitherReadNorWritten) {
  options_.use_cache = false;
  const Model model = load();
  EXPECT_FALSE(fs::exists(options_.cache_folder));
  options_.use_cache = true;
  EXPECT_EQ(load().hash, model.hash);
  options_.use_cache = false;
  EXPECT_FALSE(load().from_cache);
}

TEST_F(ModelCache, AnyChangedFileInvalidatesTheEntry) {
  const std::string before = load().hash;
  temp_.write("paint.ppm", testing::ppm(1, 1, "xyz"));
  const Model repainted = load();
  EXPECT_FALSE(repainted.from_cache);
  EXPECT_NE(repainted.hash, before);
  EXPECT_EQ(repainted.textures.at(0).texels.at(0), 'x');
  EXPECT_TRUE(load().from_cache);
  temp_.write("a.mtl", "newmtl paint\nKd 1 0 0\n");
  EXPECT_FALSE(load().from_cache);
  EXPECT_EQ(load().materials.at(0).diffuse, Eigen::Vector3f(1, 0, 0));
  temp_.write("a.obj", testing::quad_obj("a.mtl") + "f 1/1 2/2 3/3\n");
  EXPECT_EQ(load().mesh.triangles.size(), 3U);
}

TEST_F(ModelCache, ATextureThatAppearsInvalidatesTheEntry) {
  EXPECT_EQ(load().missing_textures.size(), 1U);
  temp_.write("shine.ppm", testing::ppm(1, 1, "abc"));
  const Model model = load();
  EXPECT_FALSE(model.from_cache);
  EXPECT_TRUE(model.missing_textures.empty());
}

TEST_F(ModelCache, ATextureThatAppearsInOtherCaseInvalidatesTheEntry) {
  EXPECT_EQ(load().missing_textures.size(), 1U);
  temp_.write("SHINE.PPM", testing::ppm(1, 1, "abc"));
  EXPECT_TRUE(load().missing_textures.empty());
}

TEST_F(ModelCache, AMaterialFileThatAppearsInvalidatesTheEntry) {
  const fs::path bare = temp_.write("b.obj", testing::quad_obj("b.mtl"));
  EXPECT_NE(testing::load(bare, options_).materials.at(0).diffuse, Eigen::Vector3f(0, 1, 0));
  EXPECT_TRUE(testing::load(bare, options_).from_cache);
  temp_.write("b.mtl", "newmtl paint\nKd 0 1 0\n");
  EXPECT_EQ(testing::load(bare, options_).materials.at(0).diffuse, Eigen::Vector3f(0, 1, 0));
}

TEST_F(ModelCache, ARemovedTextureInvalidatesTheEntry) {
  EXPECT_EQ(load().textures.size(), 1U);
  fs::remove(temp_.path() / "paint.ppm");
  EXPECT_EQ(load().textures.size(), 0U);
}

TEST_F(ModelCache, OptionsThatAffectTheModelHaveSeparateEntries) {
  load();
  options_.crease_angle_rad = 0.1;
  EXPECT_FALSE(load().from_cache);
  EXPECT_EQ(cache_files(), 2U);
  options_.metres_per_unit = 0.001;  // applied afterwards
  options_.up = Axis::y;
  EXPECT_TRUE(load().from_cache);
}

TEST_F(ModelCache, ACorruptFileIsReplaced) {
  load();
  const std::string whole = testing::read_file(cache_file());
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{10}, whole.size() / 2, whole.size() - 1}) {
    fs::resize_file(cache_file(), size);
    EXPECT_FALSE(load().from_cache) << size;
    EXPECT_TRUE(load().from_cache) << size;
  }
  std::string damaged = whole;
  damaged[damaged.size() - 20] ^= 1;
  std::ofstream(cache_file(), std::ios::binary) << damaged;
  EXPECT_FALSE(load().from_cache);
  EXPECT_EQ(testing::read_file(cache_file()), whole);
}

TEST_F(ModelCache, TextureFoldersAreReadInTheSandboxAndBelongToTheEntry) {
  const TestFolder art;
  const fs::path hidden = art.write("other/shine.ppm", testing::ppm(1, 1, "abc"));
  EXPECT_EQ(load().missing_textures.size(), 1U);
  options_.texture_folders = {art.path()};
  EXPECT_EQ(load().missing_textures.size(), 1U);  // not below a deeper folder
  options_.texture_folders = {art.path(), art.path() / "other"};
  const Model found = load();
  EXPECT_FALSE(found.from_cache);
  EXPECT_EQ(found.missing_textures.size(), 0U);
  EXPECT_EQ(found.files.back(), hidden.string());
  EXPECT_TRUE(load().from_cache);
  art.write("other/shine.ppm", testing::ppm(1, 1, "abd"));
  EXPECT_FALSE(load().from_cache);
  art.write("shine.ppm", testing::ppm(2, 1, "abc"));  // is searched first
  const Model other = load();
  EXPECT_FALSE(other.from_cache);
  EXPECT_EQ(other.files.back(), (art.path() / "shine.ppm").string());
  options_.texture_folders = {art.path() / "gone"};
  EXPECT_THAT(testing::load_error(file_, options_), HasSubstr("gone' is not a folder"));
}

TEST_F(ModelCache, AnotherImporterInvalidatesTheEntry) {
  load();
  auto entry = cache_entry(fs::canonical(file_), options_, {});
  ASSERT_TRUE(entry);
  EXPECT_TRUE(read_cache(*entry, fs::canonical(file_)).has_value());
  entry->importer += "x";
  EXPECT_FALSE(read_cache(*entry, fs::canonical(file_)).has_value());
}

TEST_F(ModelCache, AnUpgradedImporterLibraryInvalidatesTheEntry) {
  load();
  std::FILE* opened = std::fopen(cache_file().c_str(), "rb");
  BlockReader block(::fileno(opened));
  const std::vector<std::string> used = read_cached_file(block).imported.libraries;
  std::fclose(opened);
  const auto assimp = std::find_if(used.begin(), used.end(), [](const std::string& path) {
    return path.find("libassimp") != std::string::npos;
  });
  ASSERT_NE(assimp, used.end());

  const TestFolder libraries;
  const fs::path copy = libraries.path() / fs::path(*assimp).filename();
  fs::copy_file(*assimp, copy);
  const Variable path("LD_LIBRARY_PATH", libraries.path().string());
  EXPECT_FALSE(load().from_cache);
  EXPECT_TRUE(load().from_cache);
  fs::last_write_time(copy, fs::last_write_time(copy) + std::chrono::seconds(1));
  EXPECT_FALSE(load().from_cache);
  EXPECT_TRUE(load().from_cache);
  fs::remove(copy);  // then the system's own is used again
  EXPECT_FALSE(load().from_cache);
}

TEST_F(ModelCache, AnUnwritableFolderCausesOnlyAWarning) {
  cache_.write("models", "a file in its place");
  std::string reported;
  const Report report{[&reported](Severity, std::string_view text) { reported += text; }, {}};
  const Model model = load_model(file_.string(), options_, report);
  EXPECT_EQ(model.mesh.triangles.size(), 2U);
  EXPECT_THAT(reported, HasSubstr("cache"));
}

/// A cache entry is one piece: the index of one model and the mesh of another are no model.
TEST_F(ModelCache, MixedPartsOfTwoEntriesAreRejected) {
  const fs::path other = temp_.write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  load();
  const std::string own_name = entry_name();
  const std::string own = testing::read_file(options_.cache_folder / own_name);
  testing::load(other, options_);
  std::string theirs;
  for (const auto& entry : fs::directory_iterator(options_.cache_folder)) {
    if (entry.path().filename() != own_name) theirs = testing::read_file(entry.path());
  }
  ASSERT_FALSE(theirs.empty());
  // Wherever two files are joined, with the head of either: at least one byte is foreign.
  for (std::size_t cut = 1; cut < std::min(own.size(), theirs.size()); cut += 101) {
    std::ofstream(options_.cache_folder / own_name, std::ios::binary)
        << own.substr(0, cut) + theirs.substr(cut);
    ASSERT_FALSE(load().from_cache) << cut;
  }
  // An entry of another model under this one's name.
  std::ofstream(options_.cache_folder / own_name, std::ios::binary) << theirs;
  EXPECT_FALSE(load().from_cache);
  EXPECT_TRUE(load().from_cache);
}

/// Replaces the model by another file while the import process runs: the script moves it there once
/// the true import program has answered.
TEST_F(ModelCache, AFileReplacedDuringTheImportIsNotCached) {
  const std::string importer = import_program().string();
  const fs::path script = temp_.write(
      "import", "#!/bin/sh\n'" + importer + "' \"$1\" \"$2\" \"$3\" \"$4\" $$\n" + "code=$?\nmv '" +
                    (temp_ / "new.obj").string() + "' \"$1\"\n" + "exit $code\n");
  fs::permissions(script, fs::perms::owner_all);
  temp_.write("new.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string old_hash = load().hash;
  fs::remove_all(options_.cache_folder);
  {
    const Variable helper("GLIDAR_IMPORT_HELPER", script.string());
    std::string text;
    const Report report{[&text](Severity, std::string_view message) { text += message; }, {}};
    const Model model = load_model(file_.string(), options_, report);
    EXPECT_EQ(model.mesh.triangles.size(), 2U);
    EXPECT_EQ(model.hash, old_hash);  // of what was parsed, not of what is there now
    EXPECT_THAT(text, HasSubstr("a.obj was changed while it was read"));
  }
  EXPECT_EQ(cache_files(), 0U);
  const Model after = load();
  EXPECT_FALSE(after.from_cache);
  EXPECT_EQ(after.mesh.triangles.size(), 1U);
  EXPECT_NE(after.hash, old_hash);
}

/// A malicious model may compromise the import process, which then returns arbitrary data.
TEST_F(ModelCache, UnverifiedHashesOfTheImportProcessAreNotCached) {
  ImportedModel imported;
  imported.files = {file_.string()};
  imported.hashes = {std::string(32, '0')};
  EXPECT_EQ(changed_file(imported, file_), file_.string());
  imported.hashes = {hex(*hash_file(file_))};
  EXPECT_EQ(changed_file(imported, file_), "");
  imported.material_folders = {"/etc"};
  EXPECT_THROW(changed_file(imported, file_), Error);
  imported.material_folders = {};
  imported.files.emplace_back("/etc/passwd");
  imported.hashes.push_back(hex(*hash_file("/etc/passwd")));
  EXPECT_THROW(changed_file(imported, file_), Error);
  EXPECT_THROW(changed_file(imported, file_, {"/etc/ssl"}), Error);
  EXPECT_EQ(changed_file(imported, file_, {"/etc"}), "");
  imported.files = {(temp_ / "a.mtl").string()};
  EXPECT_THROW(changed_file(imported, file_), Error);
}

TEST_F(ModelCache, ConcurrentLoadsBothGetTheModel) {
  std::vector<std::thread> threads;
  std::vector<std::string> hashes(4);
  for (std::string& hash : hashes) threads.emplace_back([&] { hash = load().hash; });
  for (std::thread& thread : threads) thread.join();
  for (const std::string& hash : hashes) EXPECT_EQ(hash, hashes.front());
  EXPECT_EQ(cache_files(), 1U);
  EXPECT_TRUE(load().from_cache);
}

TEST_F(ModelCache, TheHashDependsOnContentsAndNotOnPaths) {
  const std::string here = load().hash;
  const TestFolder other;
  fs::copy(temp_.path(), other.path(), fs::copy_options::recursive);
  EXPECT_EQ(testing::load(other.path() / "a.obj", options_).hash, here);
}

}  // namespace
}  // namespace glidar
