// Colours: from which face each pixel shows to red, green and blue.
//
// The light: a sun, its shadows hard, and a sky that lightens what looks up more. Far away everything fades into the
// horizon's colour. Ground and meshes carry checks of 0.5 m and lines of 0.1 m, by which speed and distance are seen;
// boxes lines of 0.1 m and a dark edge of 12 mm, so that steps stand out. All is averaged over a pixel (pattern.hpp),
// but for the borders of faces and shadows, which are as sharp as the pixels. Thread safety: none; one for each
// renderer.
#pragma once

#include "camera/pattern.hpp"
#include "camera/picture.hpp"
#include "camera/screen_faces.hpp"
#include "camera/visibility.hpp"

namespace kenaf::camera {

class Shading {
 public:
  // `out` takes the view's size. `faces` has begun this view.
  void shade(const View& view, const KeyPicture& keys, ScreenFaces& faces, Picture& out) const;

 private:
  Pattern pattern_;
};

}  // namespace kenaf::camera
