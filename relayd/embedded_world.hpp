// The world server in this process: --embedded.
#pragma once

#include <cstdint>
#include <memory>
#include <thread>

#include "relayd/options.hpp"
#include "server/image_server/served_cameras.hpp"
#include "server/live/view.hpp"
#include "server/world_server/world_server.hpp"

namespace kenaf::relayd {

// Runs from construction to destruction, on a free loopback port. The constructor throws std::runtime_error with a text
// for the user.
class EmbeddedWorldServer {
 public:
  explicit EmbeddedWorldServer(const EmbeddedWorld& options);
  ~EmbeddedWorldServer();
  std::uint16_t port() const { return server_.port(); }

 private:
  world_server::WorldServer server_;
  image_server::ServedCameras cameras_;
  std::unique_ptr<live::View> view_;  // ends after the thread, and before the cameras and the server
  std::thread thread_;
};

}  // namespace kenaf::relayd
