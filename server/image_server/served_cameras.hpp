// The cameras of a world server as started by programs: the feed, and the image server.
#pragma once

#include <memory>
#include <string>

#include "server/image_server/feed.hpp"
#include "server/image_server/image_server.hpp"

namespace kenaf::image_server {

struct ServedCameras {
  std::unique_ptr<Feed> feed;                 // null: the cameras are off
  std::unique_ptr<ImageServer> image_server;  // null: it is off, or could not listen; destroyed before the feed
};

// Logs the address of the image server, or why it is not available; the program continues without it, unless its port
// was asked for: then throws std::runtime_error with a text for the user. `world` must outlive the result.
ServedCameras open_cameras(world_server::WorldServer& world, const CameraOptions& options, const std::string& address);

}  // namespace kenaf::image_server
