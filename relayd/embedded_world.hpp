// The world server in this process: --embedded.
#pragma once

#include <cstdint>
#include <memory>
#include <thread>

#include "camera/server/served_cameras.hpp"
#include "live/view.hpp"
#include "physics/server/world_server.hpp"
#include "relayd/options.hpp"

namespace kenaf::relayd {

// Runs from construction to destruction, on a free loopback port. The constructor throws std::runtime_error in words.
class EmbeddedWorldServer {
 public:
  explicit EmbeddedWorldServer(const EmbeddedWorld& options);
  ~EmbeddedWorldServer();
  std::uint16_t port() const { return server_.port(); }

 private:
  server::WorldServer server_;
  camera::ServedCameras cameras_;
  std::unique_ptr<live::View> view_;  // ends after the thread, and before the cameras and the server
  std::thread thread_;
};

}  // namespace kenaf::relayd
