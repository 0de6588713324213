// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// The reader of glTF, in this process: whatever the bytes are, it gives a model whose triangles
// have vertices, or throws Refusal.
#include "demand.hpp"
#include "input_cost.hpp"

#include <import/gltf/read_gltf.hpp>

#include <cstddef>
#include <cstdint>
#include <new>
#include <string>
#include <string_view>

namespace glidar::testing {
namespace {

void check(const import::SourceModel& model) {
  for (const import::SourceMesh& mesh : model.meshes) {
    const std::size_t vertices = mesh.positions.size();
    demand(mesh.material < model.materials.size(), "a mesh has a material of the model");
    for (const std::size_t size :
         {mesh.normals.size(), mesh.tangents.size(), mesh.uvs[0].size(), mesh.colours.size()}) {
      demand(size == 0 || size == vertices, "attributes have a value for each vertex");
    }
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t corner : triangle) demand(corner < vertices, "corners are vertices");
    }
  }
  for (const import::Placed& placed : model.placed) {
    demand(placed.mesh < model.meshes.size(), "a placed mesh exists");
  }
}

}  // namespace
}  // namespace glidar::testing

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glidar;
  const testing::InputCost cost(size);
  // Files beside the model have these bytes.
  static const std::string kBeside(4096, '\1');
  try {
    testing::check(
        import::gltf::read_gltf({reinterpret_cast<const char*>(data), size},
                                [](const std::string&) -> std::string_view { return kBeside; }));
  } catch (const import::Refusal&) {  // as it should be
  } catch (const std::bad_alloc&) {   // by a limit of memory
  }
  return 0;
}
