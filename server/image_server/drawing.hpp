// The pictures of one camera in one size, while somebody looks at them.
#pragma once

#include <cstddef>
#include <memory>

#include "camera/jpeg.hpp"
#include "camera/renderer.hpp"
#include "server/image_server/exposure.hpp"
#include "server/image_server/frame.hpp"

namespace kenaf::image_server {

// Thread safety: none.
class Drawing {
 public:
  bool has_image() const { return image_ != nullptr; }

  // Returns what the camera saw at the exposure: a new image, or the one before where nothing has moved since
  // (camera::look_alike), as most robots stand most of the time. `robot` and `camera` are indices into the exposure's
  // snapshot and that robot's description; `scene` is as at the exposure. Throws what camera::Renderer and
  // camera::JpegEncoder do; the image before is then kept.
  std::shared_ptr<const CameraImage> draw(const camera::Scene& scene, const Exposure& exposure, std::size_t robot,
                                          std::size_t camera, PictureSize size, camera::JpegEncoder& encoder);

 private:
  std::unique_ptr<camera::Renderer> renderer_;
  // The last image, null: none; and what it shows.
  std::shared_ptr<const CameraImage> image_;
  camera::WorldSnapshot world_;
  double field_of_view_rad_ = 0;
};

}  // namespace kenaf::image_server
