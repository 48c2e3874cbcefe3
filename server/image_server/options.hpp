// Whether and how pictures are served, as the command lines of kenaf-world and kenaf-relayd say it.
#pragma once

#include <cstdint>
#include <string_view>

namespace kenaf::image_server {

// What the image server sends to OK. The numbers are those on the wire.
enum class ImageType : std::uint8_t { raw = 0, superb = 1, good = 2, normal = 3, fair = 4, bad = 5 };

struct CameraOptions {
  bool on = true;  // false: no camera at all, neither here nor in the live view
  bool image_server = true;
  std::uint16_t image_port = 5003;  // 0: any free one
  ImageType image_type = ImageType::good;
  bool operator==(const CameraOptions&) const = default;
};

// "on" or "off". Throws std::runtime_error in words, as the others do.
void set_cameras(CameraOptions& options, std::string_view text);
// "off" or a port.
void set_camera_port(CameraOptions& options, std::string_view text);
// "raw", "superb", "good", "normal", "fair" or "bad".
void set_camera_image(CameraOptions& options, std::string_view text);

// The JPEG quality, 1 to 100, that stands behind a type; good is the camera's own. Not for raw.
int jpeg_quality(ImageType type, int own_quality);

}  // namespace kenaf::image_server
