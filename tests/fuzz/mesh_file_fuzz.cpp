// Any bytes are a mesh or are refused with a DescriptionError. The first byte chooses the format.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "physics/mesh_file.hpp"
#include "physics/robot_description.hpp"

// Assimp loses memory where it gives up on a file; that is no fault of this project's.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libassimp";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf::physics;
  constexpr std::size_t kMostTriangles = 1000;
  if (size < 1) return 0;
  const MeshFormat format = data[0] == 's' ? MeshFormat::stl : data[0] == 'o' ? MeshFormat::obj : MeshFormat::dae;
  try {
    MeshContent mesh =
        read_mesh({reinterpret_cast<const char*>(data) + 1, size - 1}, format, {"", data[0] == 'c'}, kMostTriangles);
    if (mesh.surface.triangles.empty() || mesh.surface.triangles.size() > kMostTriangles) __builtin_trap();
    for (const auto& triangle : mesh.surface.triangles)
      for (const std::uint32_t corner : triangle)
        if (corner >= mesh.surface.vertices.size()) __builtin_trap();
    if (tidy(mesh.surface).closed && volume_m3(mesh.surface) < -1e-3) __builtin_trap();
  } catch (const kenaf::description::DescriptionError&) {
  }
  return 0;
}
