// Which face each pixel shows, and whether the sun reaches it there.
//
// Rays are cast at the corners of cells of 8 x 8 pixels. Where all four meet one plane face, in the light or in the
// shade alike, the cell shows that face; else it is quartered, down to the pixel. On a mesh it is enough that the four
// triangles' planes and light are nearly those of one smooth surface; each pixel then takes the nearest corner's. Where
// all four are in the light, what lies between them on the mesh is taken to be, too.
//
// A box or a part of a robot that looks smaller than 32 pixels could lie between the corners: what may show it is cast
// pixel by pixel. What else is thinner than 8 pixels and shows at no corner is missed, shadows too. Before a step that
// is no pixel or 5 of 307,200, before a step field 0.02 %; on hills 0.10 % differ by more than 8 of 255 levels.
//
// Thread safety: none; one for each renderer.
#pragma once

#include <cstdint>
#include <vector>

#include "camera/screen_faces.hpp"

namespace kenaf::camera {

// A FaceId, and this bit where the face is in the shade. kNothing: the sky.
using PixelKey = std::uint32_t;
inline constexpr PixelKey kShade = 0x80000000;

// Rows of pixel keys; longer and more than the picture's, so that its last cells are whole.
struct KeyPicture {
  int stride = 0, rows = 0;
  std::vector<PixelKey> keys;
  PixelKey* row(int y) { return &keys[static_cast<std::size_t>(y) * static_cast<std::size_t>(stride)]; }
  const PixelKey* row(int y) const { return &keys[static_cast<std::size_t>(y) * static_cast<std::size_t>(stride)]; }
};

class Visibility {
 public:
  // `coarsest`: 8, or 1 for a ray through each pixel. `faces` has begun this scene and view.
  void find(const Scene& scene, const View& view, int coarsest, ScreenFaces& faces, KeyPicture& out);
  // Rays of the last find(), those toward the sun among them.
  std::size_t ray_count() const { return ray_count_; }

 private:
  struct Cell {
    std::int16_t x, y;
  };
  struct Request {
    std::int16_t x, y;
    bool mesh_is_lit;  // where it meets a mesh; else only a ray toward the sun can tell
  };

  void mark_small(const Scene& scene, const View& view, int cell);
  bool is_marked(const Cell& cell, int coarsest) const;
  void request(int x, int y, bool mesh_is_lit, KeyPicture& out);
  void cast_requested(const Scene& scene, const View& view, ScreenFaces& faces, KeyPicture& out);
  void light(const Scene& scene, ScreenFaces& faces, const Request* requests, KeyPicture& out);

  std::vector<Cell> cells_, next_cells_;
  std::vector<Request> requested_;
  std::vector<std::uint8_t> marked_;  // of each coarsest cell: it is cast pixel by pixel
  int marked_columns_ = 0;
  std::vector<std::uint32_t> toward_sun_of_;  // which ray of the batch each ray toward the sun belongs to
  RayBatch rays_, sun_rays_;
  std::size_t ray_count_ = 0;
};

}  // namespace kenaf::camera
