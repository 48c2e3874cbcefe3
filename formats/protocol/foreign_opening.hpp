// Which other protocol a connection to a text port begins with. A web page of any origin can make a browser send HTTP
// to a port of this machine with lines of the page's choice in the body (Fetch Standard, mode "no-cors"), so whoever
// begins so must not be obeyed.
//
// Thread safety: foreign_protocol() is pure; an Opening is a value.
#pragma once

#include <string>
#include <string_view>

namespace kenaf::protocol {

// Returns "HTTP", "TLS" or "SSH"; empty: none of them. `opening`: the first line, or as much of it as has come;
// `is_whole`: all of it. TLS is known by its first byte (RFC 8446, 5.1), SSH by "SSH-" (RFC 4253, 4.2), HTTP by a
// browser's method and a blank, or by a whole line with its version (RFC 9112, 3) that is not a USARSim message.
std::string_view foreign_protocol(std::string_view opening, bool is_whole);

// The opening of one connection, however its bytes are cut. Every port whose clients send text or bytes of a protocol
// other than HTTP passes all that it receives through one, before it obeys any of it.
class Opening {
 public:
  // Takes the next bytes received. Returns the other protocol's name in the call in which it shows; empty before,
  // after, and for a connection that speaks none of them. Decides at the first line's end, or after 1 KiB without one:
  // a browser's request shows in its first eight bytes.
  std::string_view take(std::string_view bytes);

 private:
  static constexpr std::size_t kMost_bytes = 1024;

  std::string first_line_;  // as much of it as has come
  bool decided_ = false;
};

}  // namespace kenaf::protocol
