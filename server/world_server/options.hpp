#pragma once

#include <cstdint>
#include <string>

namespace kenaf::world_server {

struct ServerOptions {
  std::string world = "flat";   // a shipped name or an SDF file
  std::string robot = "kenaf";  // a shipped name or a TOML file: the robot of class USARBot.Kenaf
  std::string listen_address = "127.0.0.1";
  std::uint16_t port = 3000;  // 0: any free one
  double speed = 1;           // times real time; 0 = as fast as possible
  bool udk_dialect = false;
  std::uint64_t seed = 1;  // of the sensors' noise
  double time_step_s = 0.001;
  double lockstep_wait_s = 2;  // wall-clock time that lock step waits for an answer
  // Wall-clock time without an acknowledgement of the client's machine after which its robot is stopped; 0: never. A
  // machine that lives acknowledges every second.
  double peer_silence_s = 2;
  // Wall-clock time without a word after which a connection without a robot gives way when all are taken.
  double idle_s = 10;
};

}  // namespace kenaf::world_server
