// Whether the machine at the other end of a connection still lives, as TCP knows it: from acknowledgements, whatever
// the program there says. A program that says nothing is alive as long as its machine acknowledges for it; one that was
// switched off or cut off is not, although no connection was closed.
//
// Thread safety: pure. `socket`: the descriptor of a connected TCP socket; other descriptors are left as they are.
#pragma once

namespace kenaf::world_server {

// A connection ends when its peer's machine has acknowledged nothing for so long, in wall-clock time: neither what was
// sent to it, nor, while nothing is sent, a probe each second (RFC 9293, 3.8.4; RFC 5482).
inline constexpr double kPeerGone_s = 5;

// Has the system end the connection so: the next read or write fails with ETIMEDOUT.
void end_with_peer(int socket);

// Returns the wall-clock seconds since anything came from the peer's machine, an acknowledgement or data: at most
// slightly above 1 while it lives, if end_with_peer() was called. 0 if the system does not say.
double unheard_of_s(int socket);

}  // namespace kenaf::world_server
