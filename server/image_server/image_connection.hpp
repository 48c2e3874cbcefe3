// One reader of the image server, and what all of them share. On the image server's thread alone.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <map>
#include <memory>
#include <vector>

#include "camera/jpeg.hpp"
#include "server/image_server/feed.hpp"
#include "server/image_server/image_server.hpp"

namespace kenaf::image_server {

using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;

class ImageReader {
 public:
  // There may be something new.
  virtual void look() = 0;

 protected:
  ~ImageReader() = default;
};

struct ImageDesk {
  Feed& feed;
  const ImageServerLimits limits;
  const ImageType type;

  std::vector<ImageReader*> readers{};
  camera::JpegEncoder encoder{};

  // What was made of a camera's newest frame for one reader is every other's too.
  struct Made {
    std::shared_ptr<const Frame> frame;
    Bytes bytes;
  };
  std::map<CameraId, Made> made{};
  // The frame as `type` says: raw, or a JPEG of that quality.
  Bytes make(const std::shared_ptr<const Frame>& frame);
};

// Serves until the reader is gone or does not read; meanwhile it is in desk.readers.
void serve_images(ImageDesk& desk, boost::asio::ip::tcp::socket socket);

}  // namespace kenaf::image_server
