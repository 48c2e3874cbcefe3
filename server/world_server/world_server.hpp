// The world server: a simulated world behind the USARSim protocol. Described in docs/world-server-protocol.md.
//
// The thread that calls run() owns the world, the clock and all connections.
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
  // Loads the world and the robot, binds and listens. Throws std::runtime_error with a text for the user if any of it
  // fails.
  explicit WorldServer(const ServerOptions& options);
  ~WorldServer();
  WorldServer(const WorldServer&) = delete;
  WorldServer& operator=(const WorldServer&) = delete;

  // The port it listens on: the requested one, or the free one found.
  std::uint16_t port() const;
  // These never change: for any thread.
  const physics::WorldDescription& world_description() const;
  double time_step_s() const;
  // Serves until stop(); then every connection is closed.
  void run();
  // May be called from any thread, at any time; run() returns soon, or at once if called later.
  void stop();
  // May be called from any thread, at any time: the thread in run() carries out `request` between two steps of the
  // world, within about half a millisecond, even while time is stopped, after the steps that are due. Never after run()
  // has returned. The world waits for the request, which must take only microseconds.
  void ask(std::function<void(Simulation&)> request);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kenaf::world_server
