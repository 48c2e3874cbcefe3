// Which face each pixel shows, and whether the sun reaches it there.
//
// Rays are cast at the corners of cells of 8 x 8 pixels. If all four meet one plane face, all in the light or all in
// the shade, the cell shows that face; else it is quartered, down to the pixel. On a mesh it suffices that planes and
// light of the four triangles are nearly those of one smooth surface; each pixel then takes the nearest corner's. If
// all four are in the light, the mesh between them is taken to be in the light too.
//
// A box or a part of a robot that looks smaller than 32 pixels could lie between the corners: cells that may show it
// are cast pixel by pixel. Anything else thinner than 8 pixels that shows at no corner is missed, shadows too: before a
// step 0 or 5 pixels of 307,200, before a step field 0.02 %; on hills 0.10 % differ by more than 8 of 255 levels.
//
// Thread safety: none; one for each renderer.
#pragma once

#include <cstdint>
#include <vector>

#include "camera/screen_faces.hpp"

namespace kenaf::camera {

// A FaceId, with the bit kShade if the face is in the shade there. kNothing: the sky.
using PixelKey = std::uint32_t;
inline constexpr PixelKey kShade = 0x80000000;

// Rows of pixel keys; larger than the picture, so that its last cells are complete.
struct KeyPicture {
  int stride = 0, rows = 0;
  std::vector<PixelKey> keys;
  PixelKey* row(int y) { return &keys[static_cast<std::size_t>(y) * static_cast<std::size_t>(stride)]; }
  const PixelKey* row(int y) const { return &keys[static_cast<std::size_t>(y) * static_cast<std::size_t>(stride)]; }
};

class Visibility {
 public:
  // `coarsest`: 8, or 1 for a ray through each pixel. `faces` must have begun this scene and view.
  void find(const Scene& scene, const View& view, int coarsest, ScreenFaces& faces, KeyPicture& out);
  // Number of rays of the last find(), including those toward the sun.
  std::size_t ray_count() const { return ray_count_; }

 private:
  struct Cell {
    std::int16_t x, y;
  };
  struct Request {
    std::int16_t x, y;
    bool mesh_is_lit;  // a mesh that it meets needs no ray toward the sun
  };

  void mark_small(const Scene& scene, const View& view, int cell);
  bool is_marked(const Cell& cell, int coarsest) const;
  void request(int x, int y, bool mesh_is_lit, KeyPicture& out);
  void cast_requested(const Scene& scene, const View& view, ScreenFaces& faces, KeyPicture& out);
  void light(const Scene& scene, ScreenFaces& faces, const Request* requests, KeyPicture& out);

  std::vector<Cell> cells_, next_cells_;
  std::vector<Request> requested_;
  std::vector<std::uint8_t> marked_;  // for each coarsest cell: cast it pixel by pixel
  int marked_columns_ = 0;
  std::vector<std::uint32_t> toward_sun_of_;  // index in the batch of the ray that each ray toward the sun belongs to
  RayBatch rays_, sun_rays_;
  std::size_t ray_count_ = 0;
};

}  // namespace kenaf::camera
