// Colours: from the face that each pixel shows to red, green and blue.
//
// Light: a sun with hard shadows, and a sky that is brighter on faces that look up. Far away everything fades into the
// horizon's colour. Ground and meshes have checks of 0.5 m and lines of 0.1 m, which show speed and distance; boxes
// have lines of 0.1 m and a dark edge of 12 mm, so that steps stand out. Textures are averaged over a pixel
// (pattern.hpp); the borders of faces and shadows are not. Thread safety: none; one for each renderer.
#pragma once

#include "camera/pattern.hpp"
#include "camera/picture.hpp"
#include "camera/screen_faces.hpp"
#include "camera/visibility.hpp"

namespace kenaf::camera {

class Shading {
 public:
  // `out` gets the view's size. `faces` must have begun this view.
  void shade(const View& view, const KeyPicture& keys, ScreenFaces& faces, Picture& out) const;

 private:
  Pattern pattern_;
};

}  // namespace kenaf::camera
