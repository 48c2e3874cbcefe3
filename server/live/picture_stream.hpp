// A browser that looks through a camera: one picture, or as many as it takes, one part of multipart/x-mixed-replace
// each.
#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "server/live/hub.hpp"

namespace kenaf::live {

// Of "/ROBOT/CAMERA.mjpg" or "/CAMERA.jpg" which camera (server/image_server/view_name.hpp), and whether it is a
// stream. %-escapes are decoded. Empty: the path is none of these. Pure.
struct PicturePath {
  std::string view;
  bool stream;
};
std::optional<PicturePath> parse_picture_path(std::string_view path);

class PictureReader {
 public:
  // There may be a new frame.
  virtual void look() = 0;

 protected:
  ~PictureReader() = default;
};

// Serves until the browser is gone or does not read, or the camera is. hub.cameras must not be null. A slow browser is
// sent the newest frame whenever it has taken the one before; without a new one the old one again after a second.
void start_pictures(Hub& hub, boost::beast::tcp_stream stream, const PicturePath& path);

}  // namespace kenaf::live
