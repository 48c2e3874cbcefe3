// USARSim's image server (UPIS) with the pictures of a Feed: over TCP, for clients that know nothing of Kenaf and for
// those that do. docs/cameras.md has the protocol. On a thread of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "server/image_server/feed.hpp"
#include "server/image_server/options.hpp"

namespace kenaf::image_server {

struct ImageServerLimits {
  std::size_t connections = 64;    // further ones are closed at once
  double repeat_s = 0.9;           // without a new frame the old one is sent again: within a second
  double first_s = 10;             // without any frame words are sent
  double words_apart_s = 0.1;      // between two answers in words
  double unread_s = 10;            // a reader that takes no byte for so long is closed
  int send_buffer_bytes = 262144;  // the system's; the more, the older is what a slow reader sees
};

class ImageServer {
 public:
  // Listens, and serves from then on. Throws std::runtime_error in words. The feed must be there until this has ended.
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
