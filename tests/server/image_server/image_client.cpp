#include "tests/server/image_server/image_client.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "tests/support/loopback.hpp"

namespace kenaf::image_server {

ImageClient::ImageClient(std::uint16_t port, int receive_buffer_bytes)
    : descriptor_(test::connect_to_loopback(port, receive_buffer_bytes)) {}

ImageClient::~ImageClient() {
  ::close(descriptor_);
}

bool ImageClient::send(std::string_view bytes) {
  return test::send_all(descriptor_, bytes);
}

bool ImageClient::receive(std::uint8_t* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t got = ::recv(descriptor_, bytes, count, 0);
    if (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) throw std::runtime_error("the image server is silent");
    if (got <= 0) return false;
    bytes += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

ImageClient::Image ImageClient::read() {
  std::uint8_t header[5];
  if (!receive(header, sizeof header)) throw std::runtime_error("the image server closed the connection");
  const std::size_t size = std::size_t{header[1]} << 24 | std::size_t{header[2]} << 16 | std::size_t{header[3]} << 8 |
                           std::size_t{header[4]};
  if (size > 64 << 20) throw std::runtime_error("the image server says a size of " + std::to_string(size));
  Image image{header[0], std::vector<std::uint8_t>(size)};
  if (!receive(image.bytes.data(), size)) throw std::runtime_error("the image server closed in mid-frame");
  return image;
}

bool ImageClient::hears(int milliseconds) {
  pollfd descriptor{descriptor_, POLLIN, 0};
  return ::poll(&descriptor, 1, milliseconds) > 0;
}

bool ImageClient::is_let_go() {
  std::uint8_t bytes[4096];
  try {
    while (receive(bytes, sizeof bytes)) {
    }
  } catch (const std::runtime_error&) {
    return false;
  }
  return true;
}

std::string view_request(std::string_view view) {
  return "V" + std::string(1, static_cast<char>(view.size())) + std::string(view);
}

std::string part_request(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height) {
  std::string out = "U";
  for (const std::uint32_t number : {x, y, width, height}) {
    for (const int shift : {24, 16, 8, 0}) out += static_cast<char>(number >> shift & 0xff);
  }
  return out;
}

std::optional<Stamp> stamp_of(const std::vector<std::uint8_t>& jpeg) {
  if (jpeg.size() < 6 || jpeg[0] != 0xff || jpeg[1] != 0xd8 || jpeg[2] != 0xff || jpeg[3] != 0xfe) return std::nullopt;
  const std::size_t length = std::size_t{jpeg[4]} << 8 | jpeg[5];  // these two bytes included
  if (length < 2 || jpeg.size() < 4 + length) return std::nullopt;
  const std::string text(jpeg.begin() + 6, jpeg.begin() + 4 + static_cast<std::ptrdiff_t>(length));
  Stamp stamp{};
  int names = 0;
  if (std::sscanf(text.c_str(), "kenaf-frame/1 number=%llu robot_time_s=%lf age_ms=%lf robot=%n", &stamp.number,
                  &stamp.robot_time_s, &stamp.age_ms, &names) != 3 ||
      names == 0) {
    return std::nullopt;
  }
  const std::string rest = text.substr(static_cast<std::size_t>(names));
  const std::size_t camera = rest.rfind(" camera=");
  if (camera == std::string::npos) return std::nullopt;
  stamp.robot = rest.substr(0, camera);
  stamp.camera = rest.substr(camera + 8);
  return stamp;
}

}  // namespace kenaf::image_server
