// TCP to a server of this machine, for clients that tests write by hand.
#pragma once

#include <cstdint>
#include <string_view>

namespace kenaf::test {

// A connected socket, which is the caller's to close. A read waits 20 s at most, then fails with EAGAIN. A
// `receive_buffer_bytes` above 0 makes a reader that lags behind soon. Throws std::runtime_error where nobody listens.
int connect_to_loopback(std::uint16_t port, int receive_buffer_bytes = 0);

// All of it; false: the other side has closed.
bool send_all(int descriptor, std::string_view bytes);

}  // namespace kenaf::test
