// USARSim's image server (UPIS) with the pictures of a Feed: over TCP, for clients with and without knowledge of Kenaf.
// docs/cameras.md has the protocol. On its own thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "server/image_server/feed.hpp"
#include "server/image_server/options.hpp"

namespace kenaf::image_server {

struct ImageServerLimits {
  std::size_t connections = 64;    // further ones are closed at once, unless a reader gives way
  double idle_s = 10;              // a reader that has asked nothing for so long gives way when all are taken
  double repeat_s = 0.9;           // without a new frame the old one is sent again after this: within a second
  double first_s = 10;             // without any frame a text is sent after this
  double words_apart_s = 0.1;      // between two text answers
  double unread_s = 10;            // a reader that takes no byte for this long is closed
  int send_buffer_bytes = 262144;  // of the system; the larger, the older the pictures of a slow reader
};

class ImageServer {
 public:
  // Listens and serves from construction on. Throws std::runtime_error with a text for the user. The feed must outlive
  // this.
  ImageServer(Feed& feed, const std::string& address, std::uint16_t port, ImageType type,
              const ImageServerLimits& limits = {});
  ~ImageServer();
  ImageServer(const ImageServer&) = delete;
  ImageServer& operator=(const ImageServer&) = delete;

  std::uint16_t port() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kenaf::image_server
