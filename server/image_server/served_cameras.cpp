#include "server/image_server/served_cameras.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <stdexcept>

#include "formats/protocol/host_port.hpp"

namespace kenaf::image_server {

ServedCameras open_cameras(world_server::WorldServer& world, const CameraOptions& options, const std::string& address) {
  ServedCameras cameras;
  if (!options.on) return cameras;
  cameras.feed = std::make_unique<Feed>(world);
  if (!options.image_server) return cameras;
  try {
    cameras.image_server =
        std::make_unique<ImageServer>(*cameras.feed, address, options.image_port, options.image_type);
    spdlog::info("camera pictures on {}", protocol::to_text({protocol::parse_listen_host(address).value_or(address),
                                                             cameras.image_server->port()}));
  } catch (const std::runtime_error& error) {
    if (options.port_asked_for) throw std::runtime_error(fmt::format("no image server: {}", error.what()));
    spdlog::warn("no image server: {}", error.what());
  }
  return cameras;
}

}  // namespace kenaf::image_server
