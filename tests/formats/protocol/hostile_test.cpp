#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <string_view>

#include "formats/protocol/foreign_opening.hpp"

namespace kenaf::protocol {

namespace {

struct Case {
  std::string_view bytes, protocol;
};

// The first answer of an Opening that gets `bytes` in pieces of this size, and whether it stays its only one.
std::string_view shown_by(std::string_view bytes, std::size_t piece) {
  Opening opening;
  std::string_view shown;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(piece, bytes.size()))) {
    const std::string_view now = opening.take(bytes.substr(0, piece));
    CHECK((shown.empty() || now.empty()));
    if (!now.empty()) shown = now;
  }
  return shown;
}

}  // namespace

TEST_CASE("A connection shows in its first line which other protocol it speaks, however its bytes are cut",
          "[hostile]") {
  using namespace std::string_view_literals;
  for (const auto& [bytes, protocol] : {
           Case{"POST / HTTP/1.1\r\nHost: 127.0.0.1:3000\r\n\r\nINIT {ClassName USARBot.P2DX}\r\n", "HTTP"},
           {"GET /", "HTTP"},  // of any length: its end need not come
           {"\r\n\nOPTIONS * HTTP/1.1\r\n", "HTTP"},
           {"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", "HTTP"},  // RFC 9113, 3.4
           {"BREW /pot HTTP/1.1\r\n", "HTTP"},            // a method of no browser
           {"\x16\x03\x01\x02\x00\x01"sv, "TLS"},
           {"SSH-2.0-OpenSSH_9.2p1\r\n", "SSH"},
           {"INIT {ClassName USARBot.P2DX}\r\nGET / HTTP/1.1\r\n", ""},  // a second line is none of its business
           {"INIT {Name \x16}\r\n", ""},
           {"DRIVE {Note is this HTTP/1.1}\r\n", ""},
           {"get {x}\r\n", ""},
           {"OK\r\n", ""},  // the image protocol
           {"OPTIO\r\nGET / HTTP/1.1", ""},
       }) {
    INFO(bytes);
    for (const std::size_t piece : {std::size_t{1}, std::size_t{3}, bytes.size()})
      CHECK(shown_by(bytes, piece) == protocol);
  }
}

TEST_CASE("A first byte of TLS counts at the beginning of a connection alone", "[hostile]") {
  Opening opening;
  CHECK(opening.take("I").empty());
  CHECK(opening.take("\x16\x03\x01").empty());
}

TEST_CASE("An opening without a line end is decided after 1 KiB, and holds no more than that", "[hostile]") {
  Opening opening;
  CHECK(opening.take(std::string(1023, 'x')).empty());
  CHECK(opening.take("x HTTP/1.1\r\n").empty());  // the last byte that counts
}

}  // namespace kenaf::protocol
