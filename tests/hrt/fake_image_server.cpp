#include "tests/hrt/fake_image_server.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

#include "hrt/picture_codec.hpp"
#include "tests/support/loopback.hpp"

namespace kenaf::hrt::test {

Bytes8 plain_jpeg(int width, int height, std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  CameraPicture picture;
  picture.encoding = CameraPicture::Encoding::rgb;
  picture.width = width;
  picture.height = height;
  for (int pixel = 0; pixel < width * height; ++pixel) picture.bytes.insert(picture.bytes.end(), {red, green, blue});
  Bytes8 made;
  const auto file = jpeg_file(picture, made);
  return {file.begin(), file.end()};
}

Bytes8 noted(const Bytes8& jpeg, const protocol::image::FrameNote& note) {
  const std::string segment = protocol::image::frame_note_segment(note);
  Bytes8 out(jpeg.begin(), jpeg.begin() + 2);
  out.insert(out.end(), segment.begin(), segment.end());
  out.insert(out.end(), jpeg.begin() + 2, jpeg.end());
  return out;
}

std::optional<char> FakeImageServer::Connection::byte() const {
  char c = 0;
  return recv(descriptor_, &c, 1, 0) == 1 ? std::optional(c) : std::nullopt;
}

std::optional<char> FakeImageServer::Connection::request() {
  const std::optional<char> kind = byte();
  if (kind == 'O') (void)byte();
  if (kind == 'V') {
    selected.clear();
    const std::optional<char> count = byte();
    for (int i = 0; count && i < static_cast<unsigned char>(*count); ++i) selected += byte().value_or('?');
  }
  return kind;
}

void FakeImageServer::Connection::send(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
}

void FakeImageServer::Connection::answer(std::uint8_t type, const Bytes8& data) const {
  const auto header = protocol::image::answer_header(type, static_cast<std::uint32_t>(data.size()));
  send({reinterpret_cast<const char*>(header.data()), header.size()});
  send({reinterpret_cast<const char*>(data.data()), data.size()});
}

FakeImageServer::FakeImageServer(std::function<void(Connection&)> serve) : serve_(std::move(serve)) {
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address = kenaf::test::loopback(0);
  socklen_t size = sizeof address;
  if (listener_ < 0 || bind(listener_, reinterpret_cast<sockaddr*>(&address), size) < 0 || listen(listener_, 8) < 0 ||
      getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) < 0) {
    throw std::runtime_error("no TCP socket");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { run(); });
}

FakeImageServer::~FakeImageServer() {
  stopping_ = true;
  shutdown(listener_, SHUT_RDWR);
  if (const int open = connection_; open >= 0) shutdown(open, SHUT_RDWR);
  thread_.join();
  close(listener_);
}

std::string FakeImageServer::address() const {
  return fmt::format("127.0.0.1:{}", port_);
}

void FakeImageServer::run() {
  while (!stopping_) {
    const int descriptor = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
    if (descriptor < 0) continue;
    connection_ = descriptor;
    ++connections_;
    if (!stopping_) {
      Connection connection(descriptor);
      serve_(connection);
    }
    connection_ = -1;
    close(descriptor);
  }
}

}  // namespace kenaf::hrt::test
