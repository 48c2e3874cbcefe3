// A browser that views a camera: one picture, or a stream of them as parts of multipart/x-mixed-replace.
#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "server/live/hub.hpp"

namespace kenaf::live {

// Parses "/ROBOT/CAMERA.mjpg" or "/CAMERA.jpg", and a query: the camera (server/image_server/view_name.hpp), whether it
// is a stream, and the size: "size=half", "size=full" or, without it, full. %-escapes are decoded in the path. Empty:
// the path is neither, or there is no such size. Pure.
struct PicturePath {
  std::string view;
  bool stream;
  image_server::PictureSize size;
};
std::optional<PicturePath> parse_picture_path(std::string_view path, std::string_view query);

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
