// A server of camera pictures that behaves as a test wants. Test-only.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "formats/protocol/image_message.hpp"

namespace kenaf::hrt::test {

using Bytes8 = std::vector<std::uint8_t>;

// A picture of one colour as JPEG.
Bytes8 plain_jpeg(int width, int height, std::uint8_t red, std::uint8_t green, std::uint8_t blue);
// With a frame note after its SOI, as a Kenaf server sends it.
Bytes8 noted(const Bytes8& jpeg, const protocol::image::FrameNote& note);

class FakeImageServer {
 public:
  class Connection {
   public:
    explicit Connection(int descriptor) : descriptor_(descriptor) {}
    // The next byte; nullopt at the end.
    std::optional<char> byte() const;
    // The next request, 'J', 'O' (of OK) or 'V', whose name is in `selected` then; nullopt at the end.
    std::optional<char> request();
    void send(std::string_view bytes) const;
    void answer(std::uint8_t type, const Bytes8& data) const;
    std::string selected;

   private:
    int descriptor_;
  };
  // `serve` has one connection after the other, each until it returns; at the server's end its reads end.
  explicit FakeImageServer(std::function<void(Connection&)> serve);
  ~FakeImageServer();

  std::string address() const;  // HOST:PORT
  int connections() const { return connections_; }

 private:
  void run();

  std::function<void(Connection&)> serve_;
  int listener_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<int> connection_ = -1, connections_ = 0;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace kenaf::hrt::test
