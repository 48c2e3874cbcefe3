// A browser's side of HTTP and WebSocket, by hand and without the library that the server uses: bytes out, bytes in.
// Waits at most 20 s, then throws std::runtime_error. Thread safety: one thread.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace kenaf::live {

class WebClient {
 public:
  explicit WebClient(std::uint16_t port, int receive_buffer_bytes = 0);  // loopback; 0: as the system has it
  ~WebClient();
  WebClient(const WebClient&) = delete;
  WebClient& operator=(const WebClient&) = delete;

  bool send(std::string_view bytes);  // false: the server closed
  // Until the server closes.
  std::string rest();
  // Status line, headers and body of the next answer (by its Content-Length).
  std::string answer();

  // Upgrades to a WebSocket; false: refused, and answer() had the reason.
  bool open_websocket(std::string_view target = "/ws", std::string_view more_headers = "");
  void send_text(std::string_view text);
  // The next message; nullopt: the server closed.
  std::optional<nlohmann::json> message();
  // The next of that type; others before it are dropped. Throws where the server closes.
  nlohmann::json message_of(std::string_view type);

 private:
  bool receive();  // more bytes; false: closed
  std::string take(std::size_t count);

  int descriptor_;
  std::string received_;
};

// "GET target HTTP/1.1" with a Host that is allowed.
std::string get(std::string_view target, std::string_view more_headers = "");

}  // namespace kenaf::live
