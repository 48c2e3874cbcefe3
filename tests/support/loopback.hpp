// Sockets within this machine, for peers that tests write by hand.
#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <string_view>

namespace kenaf::test {

// 127.0.0.1; port 0: a free one, which the system chooses when the socket is bound.
sockaddr_in loopback(std::uint16_t port);

// Whether this machine has the IPv6 address ::1.
bool has_ipv6_loopback();

// A TCP connection, which is the caller's to close. A read waits 20 s at most, then fails with EAGAIN. A
// `receive_buffer_bytes` above 0 makes a reader that lags behind soon. Throws std::runtime_error where nobody listens.
int connect_to_loopback(std::uint16_t port, int receive_buffer_bytes = 0);

// All of it; false: the other side has closed.
bool send_all(int descriptor, std::string_view bytes);

}  // namespace kenaf::test
