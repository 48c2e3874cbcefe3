// Which other protocol a connection to a text port begins with. A web page of any origin can make a browser send HTTP
// to a port of this machine with lines of the page's choice in the body (Fetch Standard, mode "no-cors"), so whoever
// begins so must not be obeyed.
//
// Thread safety: pure.
#pragma once

#include <string_view>

namespace kenaf::protocol {

// Returns "HTTP", "TLS" or "SSH"; empty: none of them. `opening`: the first line, or as much of it as has come. TLS is
// known by its first byte (RFC 8446, 5.1), SSH by "SSH-" (RFC 4253, 4.2), HTTP by a browser's method and a blank, or
// by a line that ends in its version (RFC 9112, 3).
std::string_view foreign_protocol(std::string_view opening);

}  // namespace kenaf::protocol
