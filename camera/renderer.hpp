// The picture of a camera: visibility (which face each pixel shows), then shading (its colour).
//
// A camera has no body: it sees its own robot like any other object.
//
// Thread safety: none; one renderer for each thread. Several renderers may show one Scene at once.
#pragma once

#include "camera/lens.hpp"
#include "camera/picture.hpp"
#include "camera/scene.hpp"
#include "camera/screen_faces.hpp"
#include "camera/shading.hpp"
#include "camera/visibility.hpp"

namespace kenaf::camera {

struct RenderSettings {
  bool every_pixel = false;  // a ray through each pixel: misses nothing, at several times the cost
};

class Renderer {
 public:
  explicit Renderer(const RenderSettings& settings = {}) : settings_(settings) {}

  // Reuses `out`: after two pictures of a size, another one that shows no more than they did allocates nothing.
  void render(const Scene& scene, const View& view, Picture& out);

  std::size_t ray_count() const { return visibility_.ray_count(); }  // of the last picture

 private:
  RenderSettings settings_;
  ScreenFaces faces_;
  Visibility visibility_;
  KeyPicture keys_;
  Shading shading_;
};

}  // namespace kenaf::camera
