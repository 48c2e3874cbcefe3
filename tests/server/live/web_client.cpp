#include "tests/server/live/web_client.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

#include "tests/support/loopback.hpp"

namespace kenaf::live {

namespace {

// The example of RFC 6455, section 1.3.
constexpr std::string_view kKey = "dGhlIHNhbXBsZSBub25jZQ==", kAccept = "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=";

}  // namespace

WebClient::WebClient(std::uint16_t port, int receive_buffer_bytes)
    : descriptor_(test::connect_to_loopback(port, receive_buffer_bytes)) {}

WebClient::~WebClient() {
  ::close(descriptor_);
}

bool WebClient::send(std::string_view bytes) {
  return test::send_all(descriptor_, bytes);
}

bool WebClient::receive() {
  char bytes[65536];
  const ssize_t count = ::recv(descriptor_, bytes, sizeof bytes, 0);
  if (count < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) throw std::runtime_error("the live view is silent");
  if (count <= 0) return false;
  received_.append(bytes, static_cast<std::size_t>(count));
  return true;
}

std::string WebClient::rest() {
  while (receive()) {
  }
  return take(received_.size());
}

std::string WebClient::take(std::size_t count) {
  while (received_.size() < count) {
    if (!receive()) throw std::runtime_error("the live view closed the connection");
  }
  std::string out = received_.substr(0, count);
  received_.erase(0, count);
  return out;
}

std::string WebClient::answer() {
  std::size_t end = 0;
  while ((end = received_.find("\r\n\r\n")) == std::string::npos) {
    if (!receive()) throw std::runtime_error("the live view closed the connection");
  }
  std::string headers = take(end + 4);
  const std::size_t length = headers.find("Content-Length: ");
  return length == std::string::npos ? headers : headers + take(std::stoul(headers.substr(length + 16)));
}

bool WebClient::open_websocket(std::string_view target, std::string_view more_headers) {
  send(get(target, "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: " +
                       std::string(kKey) + "\r\n" + std::string(more_headers)));
  const std::string headers = answer();
  return headers.starts_with("HTTP/1.1 101") && headers.find(kAccept) != std::string::npos;
}

// One frame, masked with zeros, as RFC 6455 section 5.2 asks of a client.
void WebClient::send_text(std::string_view text) {
  std::string frame = "\x81";
  if (text.size() < 126) {
    frame += static_cast<char>(0x80 | text.size());
  } else {
    frame += static_cast<char>(0x80 | 126);
    frame += static_cast<char>(text.size() >> 8);
    frame += static_cast<char>(text.size() & 0xff);
  }
  frame.append(4, '\0');
  frame += text;
  send(frame);
}

// A long message comes in fragments, between which there may be pings: RFC 6455 section 5.4.
std::optional<nlohmann::json> WebClient::message() {
  std::string text;
  for (;;) {
    try {
      const std::string head = take(2);
      std::size_t length = static_cast<unsigned char>(head[1]) & 0x7f;
      if (length >= 126) {
        const std::string more = take(length == 126 ? 2 : 8);
        length = 0;
        for (const char byte : more) length = length << 8 | static_cast<unsigned char>(byte);
      }
      const std::string payload = take(length);
      const int opcode = head[0] & 0x0f;
      if (opcode == 8) return std::nullopt;
      if (opcode == 9) send(std::string("\x8a\x80\0\0\0\0", 6));  // a ping: somebody is here
      if (opcode > 1) continue;
      text += payload;
      const bool is_last = (head[0] & 0x80) != 0;
      if (is_last) return nlohmann::json::parse(text);
    } catch (const nlohmann::json::exception&) {
      throw;
    } catch (const std::runtime_error& error) {
      if (std::string_view(error.what()).find("closed") != std::string_view::npos) return std::nullopt;
      throw;
    }
  }
}

nlohmann::json WebClient::message_of(std::string_view type) {
  while (auto next = message()) {
    if ((*next)["type"] == type) return *next;
  }
  throw std::runtime_error("the live view closed the connection");
}

std::string get(std::string_view target, std::string_view more_headers) {
  return "GET " + std::string(target) + " HTTP/1.1\r\nHost: 127.0.0.1\r\n" + std::string(more_headers) + "\r\n";
}

}  // namespace kenaf::live
