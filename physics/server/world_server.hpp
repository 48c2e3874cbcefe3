// The world server: a simulated world behind the USARSim protocol. docs/world-server-protocol.md is the page for
// people.
//
// One thread, that which calls run(), owns the world, the clock and all connections.
#pragma once

#include <cstdint>
#include <memory>

#include "physics/server/options.hpp"

namespace kenaf::server {

class WorldServer {
 public:
  // Loads the world and the robot, binds and listens. Throws std::runtime_error, in words, where one of it fails.
  explicit WorldServer(const ServerOptions& options);
  ~WorldServer();
  WorldServer(const WorldServer&) = delete;
  WorldServer& operator=(const WorldServer&) = delete;

  // Where it listens: the one that was asked for, or the free one that was found.
  std::uint16_t port() const;
  // Serves until stop(); then every connection is closed.
  void run();
  // From any thread, at any time; run() returns soon, or at once where it is called later.
  void stop();

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kenaf::server
