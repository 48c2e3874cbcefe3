#include "camera/renderer.hpp"

namespace kenaf::camera {

void Renderer::render(const Scene& scene, const View& view, Picture& out) {
  constexpr int kCell = 8;
  faces_.begin(scene, view);
  visibility_.find(scene, view, settings_.every_pixel ? 1 : kCell, faces_, keys_);
  shading_.shade(view, keys_, faces_, out);
}

}  // namespace kenaf::camera
