// The world server: a simulated world behind the USARSim protocol. docs/world-server-protocol.md is the page for
// people.
//
// One thread, that which calls run(), owns the world, the clock and all connections.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "server/world_server/options.hpp"

namespace kenaf::physics {
struct WorldDescription;
}

namespace kenaf::world_server {

struct Simulation;

class WorldServer {
 public:
  // Loads the world and the robot, binds and listens. Throws std::runtime_error, in words, where one of it fails.
  explicit WorldServer(const ServerOptions& options);
  ~WorldServer();
  WorldServer(const WorldServer&) = delete;
  WorldServer& operator=(const WorldServer&) = delete;

  // Where it listens: the one that was asked for, or the free one that was found.
  std::uint16_t port() const;
  // Neither ever changes: for any thread.
  const physics::WorldDescription& world_description() const;
  double time_step_s() const;
  // Serves until stop(); then every connection is closed.
  void run();
  // From any thread, at any time; run() returns soon, or at once where it is called later.
  void stop();
  // From any thread, at any time: the thread in run() carries `request` out between two steps of the world, within half
  // a millisecond or so, also while time stands still. Never where run() has returned. The world waits for it:
  // microseconds.
  void ask(std::function<void(Simulation&)> request);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kenaf::world_server
