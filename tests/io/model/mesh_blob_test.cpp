// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/unique_fd.hpp>
#include <glidar/io/model/mesh_blob.hpp>
#include <glidar/math/constants.hpp>

#include <io/model_test_support.hpp>

#include <sys/mman.h>

#include <cmath>
#include <limits>

namespace glidar {
namespace {

UniqueFd memory_file() {
  return UniqueFd(::memfd_create("test", MFD_CLOEXEC));
}

void rewind(const UniqueFd& fd) {
  ::lseek(fd.get(), 0, SEEK_SET);
}

ImportedModel example() {
  ImportedModel imported;
  imported.files = {"/a/model.obj"};
  imported.hashes = {std::string(32, 'a')};
  imported.absent = {"/a/model.mtl"};
  imported.lookups = {{"wood.png", "/a/wood.png", ""}};
  Model& model = imported.model;
  model.format = "Test";
  model.mesh.name = "thing";
  model.mesh.origin_m = {1e6, 0.0, -3.0};
  model.mesh.positions_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  model.mesh.normals.assign(4, Eigen::Vector3f::UnitZ());
  model.mesh.uvs[0].assign(4, {0.25F, 0.5F});
  model.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  model.mesh.material_slots = {0, 1};
  model.materials.resize(2);
  model.materials[1].diffuse_texture.texture = 0;
  model.materials[1].diffuse_texture.wrap_v = Wrap::mirror;
  model.materials[1].diffuse_texture.uv_offset = {0.5F, -1.0F};
  model.textures = {{"wood.png", 2, 1, 3, {1, 2, 3, 4, 5, 6}}};
  model.parts = {{"first", 0, 1, 1}, {"second", 1, 1, 2}};
  model.nodes = {{}, {"arm", 0, Pose(Eigen::Translation3d(1.0, 0.0, 1e-3))}, {"hand", 1}};
  model.missing_textures = {{"gone.png", "not found"}};
  model.notes = {"a note"};
  model.declared = {0.0254, Axis::y};
  return imported;
}

std::string bytes_of(const ImportedModel& imported) {
  const UniqueFd fd = memory_file();
  write_model(fd.get(), imported);
  std::string bytes(static_cast<std::size_t>(::lseek(fd.get(), 0, SEEK_END)), '\0');
  EXPECT_EQ(::pread(fd.get(), bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  return bytes;
}

ImportedModel from_bytes(const std::string& bytes) {
  const UniqueFd fd = memory_file();
  EXPECT_EQ(::write(fd.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  rewind(fd);
  BlockReader block(fd.get());
  return read_model(block);
}

TEST(MeshBlob, EveryFieldSurvivesARoundTrip) {
  const ImportedModel before = example();
  const ImportedModel after = from_bytes(bytes_of(before));
  EXPECT_EQ(bytes_of(after), bytes_of(before));
  EXPECT_EQ(after.model.mesh.triangles, before.model.mesh.triangles);
  EXPECT_EQ(after.model.mesh.origin_m, before.model.mesh.origin_m);
  EXPECT_EQ(after.model.materials[1].diffuse_texture.wrap_v, Wrap::mirror);
  EXPECT_EQ(after.model.textures[0].texels, before.model.textures[0].texels);
  EXPECT_EQ(after.model.parts[1].name, "second");
  EXPECT_EQ(after.model.parts[1].node, 2U);
  ASSERT_EQ(after.model.nodes.size(), 3U);
  EXPECT_EQ(after.model.nodes[2].name, "hand");
  EXPECT_EQ(after.model.nodes[2].parent, 1U);
  EXPECT_EQ(after.model.nodes[1].model_from_node.matrix(),
            Pose(Eigen::Translation3d(1.0, 0.0, 1e-3)).matrix());
  EXPECT_EQ(after.model.missing_textures[0].reason, "not found");
  EXPECT_EQ(after.lookups, before.lookups);
}

TEST(MeshBlob, LargeArraysSurviveARoundTrip) {
  ImportedModel imported = example();
  imported.model.mesh.positions_m.assign(100'000, {1.0F, 2.0F, 3.0F});
  imported.model.mesh.normals.clear();
  imported.model.mesh.uvs[0].clear();
  EXPECT_EQ(bytes_of(from_bytes(bytes_of(imported))), bytes_of(imported));
}

TEST(MeshBlob, TruncationAnywhereIsAnError) {
  const std::string whole = bytes_of(example());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW(from_bytes(whole.substr(0, size)), Error) << size;
  }
}

TEST(MeshBlob, AFlippedBitIsAnError) {
  const std::string whole = bytes_of(example());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    EXPECT_THROW(from_bytes(damaged), Error) << i;
  }
}

// A process led astray writes a sound block around an unsound model.
TEST(MeshBlob, InvalidModelsAreRejectedDespiteAValidChecksum) {
  const float nan = kNaNf;
  const std::vector<void (*)(Model&)> harms = {
      [](Model& m) { m.mesh.triangles[0][2] = 4; },
      [](Model& m) { m.mesh.triangles.clear(); },
      [](Model& m) { m.mesh.normals.pop_back(); },
      [](Model& m) {
        m.mesh.material_slots = {0, 2};
      },
      [](Model& m) { m.materials[0].normal_texture.texture = 1; },
      [](Model& m) { m.materials[0].normal_texture.texture = -2; },
      [](Model& m) { m.materials[0].shininess = 129.0F; },
      [](Model& m) { m.materials[0].diffuse_texture.uv_set = 2; },
      [](Model& m) { m.materials[0].diffuse_texture.wrap_u = static_cast<Wrap>(7); },
      [](Model& m) { m.textures[0].width = 3; },
      [](Model& m) { m.textures[0].channels = 5; },
      [](Model& m) {
        m.textures[0] = {"", 1U << 31U, 1U << 31U, 4, {}};
      },
      [](Model& m) { m.parts[1].triangle_count = 4'000'000'000U; },
      [](Model& m) { m.parts[1].node = 3; },
      [](Model& m) { m.nodes[1].parent = 1; },
      [](Model& m) { m.nodes[1].model_from_node.matrix()(0, 0) = 2.0; },
      [](Model& m) { m.nodes[1].model_from_node.matrix()(3, 0) = 1.0; },
      [](Model& m) { m.nodes[1].model_from_node.translation().x() = std::nan(""); },
      [](Model& m) { m.declared.metres_per_unit = 0.0; },
      [](Model& m) { m.declared.up = static_cast<Axis>(3); },
      [](Model& m) {
        m.mesh.origins = {{1, 0, {0, 0, 0}}};
      },
      [](Model& m) {
        m.mesh.origins = {{0, 0, {0, 0, 0}}, {2, 1, {0, 0, 0}}};  // a triangle of two runs
      }};
  for (std::size_t i = 0; i < harms.size(); ++i) {
    ImportedModel imported = example();
    harms[i](imported.model);
    EXPECT_THROW(from_bytes(bytes_of(imported)), Error) << i;
  }
  ImportedModel imported = example();
  imported.model.mesh.positions_m[1].x() = nan;
  EXPECT_THROW(from_bytes(bytes_of(imported)), Error);
  imported = example();
  imported.model.materials[0].diffuse.x() = nan;
  EXPECT_THROW(from_bytes(bytes_of(imported)), Error);
}

TEST(MeshBlob, CountsBeyondTheDataAllocateNoMemory) {
  const UniqueFd fd = memory_file();
  BlockWriter writer(fd.get(), BlockKind::failure);
  const std::uint64_t absurd = std::numeric_limits<std::uint64_t>::max();
  writer.bytes(&absurd, sizeof absurd);
  writer.finish();
  rewind(fd);
  BlockReader block(fd.get());
  EXPECT_THROW(read_failure(block), Error);
}

TEST(MeshBlob, FramesOfAnotherTypeAreRejected) {
  const UniqueFd fd = memory_file();
  write_failure(fd.get(), {"found", "remedy"});
  rewind(fd);
  BlockReader block(fd.get());
  EXPECT_EQ(block.kind(), BlockKind::failure);
  EXPECT_THROW(read_model(block), Error);
}

TEST(MeshBlob, AFileCanContainSeveralFrames) {
  const UniqueFd fd = memory_file();
  write_failure(fd.get(), {"first", "a"});
  write_failure(fd.get(), {"second", "b"});
  rewind(fd);
  BlockReader first(fd.get());
  EXPECT_EQ(read_failure(first).found, "first");
  BlockReader second(fd.get());
  EXPECT_EQ(read_failure(second).remedy, "b");
}

}  // namespace
}  // namespace glidar
