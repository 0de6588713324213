// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/import_process.hpp>

#include <io/model_test_support.hpp>

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <algorithm>

namespace glidar {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::uint64_t kGiB = std::uint64_t{1} << 30U;
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kMeasurable = false;  // the sanitizers' own memory counts too
constexpr double kTimeLimit = 60.0;
#else
constexpr bool kMeasurable = true;
constexpr double kTimeLimit = 10.0;
#endif

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const bool model = entry.is_regular_file() && !entry.path().string().ends_with(".report.json");
    if (model && entry.file_size() > 0) files.push_back(fs::canonical(entry.path()));
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Peak resident memory of this process, which the system also counts for the processes that it
/// starts.
std::uint64_t own_peak_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) << 10U;
}

/// All files that were read are in the model's root.
void expect_confined(const ImportedModel& imported, const fs::path& file) {
  const ModelFolder folder = model_folder(file);
  for (const std::string& read : imported.files) {
    EXPECT_EQ(confine(read, folder).access, Access::granted) << read;
  }
}

/// A clear error or a good mesh, within the limits.
void expect_tamed(const fs::path& file) {
  SCOPED_TRACE(file.string());
  const ImportRequest request{file, 0.785, kTimeLimit, 0};
  const ImportRun run = run_import(request, {});
  if (kMeasurable) {
    EXPECT_LE(run.peak_memory_bytes, std::max(kGiB, own_peak_bytes()));
  }
  EXPECT_LT(run.seconds, kTimeLimit + 1.0);
  try {
    const ImportedModel imported = take_model(run, request);
    EXPECT_NO_THROW(validate(imported.model.mesh));
    EXPECT_FALSE(imported.model.mesh.triangles.empty());
    expect_confined(imported, file);
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().where, file.string());
    EXPECT_FALSE(error.parts().found.empty());
    EXPECT_FALSE(error.parts().remedy.empty());
    EXPECT_THAT(error.what(), Not(HasSubstr("root:")));
  }
}

class HostileModels : public ::testing::TestWithParam<const char*> {};

TEST_P(HostileModels, GiveAClearErrorOrAValidMesh) {
  GLIDAR_NEEDS_DATA();
  const std::vector<fs::path> files = files_below(testing::data_folder() / "hostile" / GetParam());
  ASSERT_FALSE(files.empty());
  for (const fs::path& file : files) expect_tamed(file);
}

INSTANTIATE_TEST_SUITE_P(Data, HostileModels,
                         ::testing::Values("assimp", "gltf_validator", "png", "synthetic",
                                           "tinyobj", "trimesh", "valid_but_crash_5.2.5"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

TEST(HostileModels, NoPasswordsAreRead) {
  GLIDAR_NEEDS_DATA();
  const fs::path folder = testing::data_folder() / "hostile" / "synthetic";
  for (const char* name : {"gltf/buffer_traversal.gltf", "gltf/buffer_devzero.gltf"}) {
    const std::string text = testing::load_error((folder / name).string());
    EXPECT_THAT(text, HasSubstr("is not read")) << name;
  }
  for (const char* name : {"paths/mtllib_passwd.obj", "paths/traversal.obj",
                           "gltf/image_traversal.gltf", "3mf/zip_slip.3mf"}) {
    const Model model = testing::load(folder / name);
    EXPECT_TRUE(model.textures.empty()) << name;
    for (const Material& m : model.materials) EXPECT_THAT(m.name, Not(HasSubstr("root"))) << name;
  }
  EXPECT_GE(testing::load(folder / "paths/traversal.obj").missing_textures.size(), 9U);
  EXPECT_FALSE(fs::exists("/tmp/pwned"));
}

TEST(HostileModels, HugeTexturesAreMissingWithTheirSize) {
  GLIDAR_NEEDS_DATA();
  const fs::path folder = testing::data_folder() / "hostile" / "synthetic" / "images";
  for (const char* name : {"quad_bomb_30000x30000_1bit.obj", "quad_ppm_huge.obj"}) {
    const Model model = testing::load(folder / name);
    ASSERT_EQ(model.missing_textures.size(), 1U) << name;
    EXPECT_THAT(model.missing_textures[0].reason, HasSubstr("too large")) << name;
  }
}

TEST(HostileModels, TheTiniestTriangleKeepsItsCorners) {
  GLIDAR_NEEDS_DATA();
  const Model model =
      testing::load(testing::data_folder() / "hostile/synthetic/ply/denormals_and_tiny.ply");
  EXPECT_EQ(model.mesh.positions_m.size(), 3U);
  EXPECT_EQ(model.mesh.positions_m.at(1).x(), 1e-42F);
}

TEST(HostileModels, ErrorsQuoteLittleOfAFile) {
  const testing::TestFolder folder;
  const fs::path file = folder.write("a.fbx",
                                     "; FBX 7.4.0 project file\n"
                                     "FBXHeaderExtension: {\n\tFBXVersion: 7400\n}\n"
                                     "Objects: {\n\tGeometry: \"" +
                                         std::string(5000, 'x') + "\" {\n\t}\n}\n");
  const std::string text = testing::load_error(file.string());
  EXPECT_THAT(text, HasSubstr("cannot be read"));
  EXPECT_THAT(text, HasSubstr("xxx"));
  EXPECT_LT(text.size(), file.string().size() + 400);
}

TEST(HostileModels, ACrashIsReportedWithItsSignal) {
  GLIDAR_SKIP_SANITIZED();
  GLIDAR_NEEDS_DATA();
  const std::string text = testing::load_error(
      (testing::data_folder() / "hostile/synthetic/3mf/component_cycle.3mf").string());
  EXPECT_THAT(text, HasSubstr("component_cycle.3mf"));
  EXPECT_THAT(text, HasSubstr("crashed"));
  EXPECT_THAT(text, HasSubstr("SIGSEGV"));
}

TEST(HostileModels, ExceededMemoryIsReportedWithTheLimit) {
  GLIDAR_SKIP_SANITIZED();
  GLIDAR_NEEDS_DATA();
  const std::string text = testing::load_error(
      (testing::data_folder() / "hostile/synthetic/dae/instance_bomb.dae").string());
  EXPECT_THAT(text, HasSubstr("more memory than 128 MiB"));
}

}  // namespace
}  // namespace glidar
