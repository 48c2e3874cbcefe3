// A browser that views a camera: one picture, or a stream of them as parts of multipart/x-mixed-replace.
#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "server/live/hub.hpp"

namespace kenaf::live {

// Parses "/ROBOT/CAMERA.mjpg" or "/CAMERA.jpg": the camera (server/image_server/view_name.hpp), and whether it is a
// stream. %-escapes are decoded. Empty: the path is neither. Pure.
struct PicturePath {
  std::string view;
  bool stream;
};
std::optional<PicturePath> parse_picture_path(std::string_view path);

class PictureReader {
 public:
  // A new frame may be available.
  virtual void look() = 0;

 protected:
  ~PictureReader() = default;
};

// Serves until the browser is gone or stops reading, or the camera is gone. `cameras` must outlive the hub. A slow
// browser gets the newest frame whenever it has taken the previous one; without a new frame the old one is sent again
// after a second.
void start_pictures(Hub& hub, image_server::Feed& cameras, boost::beast::tcp_stream stream, const PicturePath& path);

}  // namespace kenaf::live
