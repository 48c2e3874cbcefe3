// The world's description as bytes for a page: everything static. Pure.
//
// Little-endian; every number 4 bytes, so that a page can lay typed arrays over it. u32 magic "KNV1"; u32 counts of
// planes, boxes and meshes. A plane: p, q (w x y z). A box: size, p, q. A mesh: u32 vertices, u32 triangles, 3 f32 a
// vertex, 3 u32 a triangle. Metres, frame W.
#pragma once

#include <string>

#include "physics/world_description.hpp"

namespace kenaf::live {

inline constexpr std::uint32_t kSceneMagic = 0x31564e4b;  // "KNV1"

// Movable boxes are left out: they are in the state.
std::string scene_bytes(const physics::WorldDescription& world);

}  // namespace kenaf::live
