// The cameras of a world server as programs start them: the feed, and the image server beside it.
#pragma once

#include <memory>
#include <string>

#include "server/image_server/feed.hpp"
#include "server/image_server/image_server.hpp"

namespace kenaf::image_server {

struct ServedCameras {
  std::unique_ptr<Feed> feed;                 // null: the cameras are off
  std::unique_ptr<ImageServer> image_server;  // null: it is off, or could not listen; ends before the feed
};

// Says in the log where the image server is, or why it is not there, and the program goes on without it. `world` must
// be there until what is returned has ended.
ServedCameras open_cameras(world_server::WorldServer& world, const CameraOptions& options, const std::string& address);

}  // namespace kenaf::image_server
