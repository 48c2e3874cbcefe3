// A client of USARSim's image server, written from what is known of that protocol alone: it sends OK, reads one byte of
// type, four of size, and then so many bytes. Waits at most 20 s, then throws std::runtime_error. Thread safety: one
// thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::image_server {

class ImageClient {
 public:
  explicit ImageClient(std::uint16_t port, int receive_buffer_bytes = 0);  // loopback; 0: as the system has it
  ~ImageClient();
  ImageClient(const ImageClient&) = delete;
  ImageClient& operator=(const ImageClient&) = delete;

  struct Image {
    int type;  // 0 raw, 1 to 5 JPEG, 255 words
    std::vector<std::uint8_t> bytes;
    std::string words() const { return {bytes.begin(), bytes.end()}; }
  };
  // False: the server closed.
  bool send(std::string_view bytes);
  Image read();
  Image ask(std::string_view request = "OK") {
    send(request);
    return read();
  }
  // Whether anything has come that was not read yet, after waiting so long for it.
  bool hears(int milliseconds);
  // Whether the server has closed: whatever was under way is read and dropped.
  bool is_let_go();

 private:
  bool receive(std::uint8_t* bytes, std::size_t count);

  int descriptor_;
};

// "V" and its length before it.
std::string view_request(std::string_view view);
// "U" and four big-endian numbers.
std::string part_request(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height);

// What the comment in a JPEG of this server says; empty: the file does not begin with one.
struct Stamp {
  unsigned long long number;
  double robot_time_s, age_ms;
  std::string robot, camera;
};
std::optional<Stamp> stamp_of(const std::vector<std::uint8_t>& jpeg);

}  // namespace kenaf::image_server
