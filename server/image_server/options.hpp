// Whether and how pictures are served: command line options of kenaf-world and kenaf-relayd.
#pragma once

#include <cstdint>
#include <string_view>

namespace kenaf::image_server {

// Answer of the image server to OK. The numbers are those on the wire.
enum class ImageType : std::uint8_t { raw = 0, superb = 1, good = 2, normal = 3, fair = 4, bad = 5 };

struct CameraOptions {
  bool on = true;  // false: no cameras at all, neither here nor in the live view
  bool image_server = true;
  std::uint16_t image_port = 5003;  // 0: any free one
  ImageType image_type = ImageType::good;
  bool port_asked_for = false;  // by an option: then a program that cannot listen on it does not start
  bool operator==(const CameraOptions&) const = default;
};

// "on" or "off". Throws std::runtime_error with a text for the user, as the others do.
void set_cameras(CameraOptions& options, std::string_view text);
// "off" or a port.
void set_camera_port(CameraOptions& options, std::string_view text);
// "raw", "superb", "good", "normal", "fair" or "bad".
void set_camera_image(CameraOptions& options, std::string_view text);

// Returns the JPEG quality, 1 to 100, of a type; good is the camera's own. Not for raw.
int jpeg_quality(ImageType type, int own_quality);

}  // namespace kenaf::image_server
