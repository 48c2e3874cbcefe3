// One reader of the image server, and the state shared by all. For the image server's thread only.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "camera/jpeg.hpp"
#include "formats/protocol/log_limiter.hpp"
#include "server/image_server/feed.hpp"
#include "server/image_server/image_server.hpp"

namespace kenaf::image_server {

using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;

class ImageReader {
 public:
  // A new frame may be available.
  virtual void look() = 0;
  // The time since which the reader has neither asked nor been sent anything; nullopt: a request is waiting, or its
  // answer is on its way.
  virtual std::optional<std::chrono::steady_clock::time_point> idle_since() const = 0;
  // Disconnects it, to make room for another.
  virtual void give_way() = 0;

 protected:
  ~ImageReader() = default;
};

struct ImageDesk {
  Feed& feed;
  const ImageServerLimits limits;
  const ImageType type;

  std::vector<ImageReader*> readers{};
  protocol::LogLimiter log{20, 0.5};
  camera::JpegEncoder encoder{};

  // Encoded data of a camera's newest frame, shared by all readers.
  struct Made {
    std::shared_ptr<const Frame> frame;
    Bytes bytes;
  };
  std::map<CameraId, Made> made{};
  // Returns the frame in the format of `type`: raw, or a JPEG of that quality.
  Bytes make(const std::shared_ptr<const Frame>& frame);
};

// Serves until the reader is gone or stops reading; meanwhile it is in desk.readers.
void serve_images(ImageDesk& desk, boost::asio::ip::tcp::socket socket);

}  // namespace kenaf::image_server
