// A world server with its cameras and its live view, on free ports, in threads of this process.
#pragma once

#include <string>
#include <thread>

#include "server/live/view.hpp"
#include "server/world_server/world_server.hpp"
#include "tests/support/patience.hpp"

namespace kenaf::live {

// A page that is drawn without a graphics card may be held up for longer than a server waits for it.
inline ViewLimits patient_limits() {
  ViewLimits limits;
  limits.quiet_s = static_cast<double>(support::patience().count());
  return limits;
}

class ServedWorld {
 public:
  // `port` of the view; 0: any free one.
  explicit ServedWorld(const std::string& token = "", const ViewLimits& limits = {}, const std::string& world = "flat",
                       std::uint16_t port = 0)
      : server_(server_options(world)),
        cameras_(server_),
        view_(server_, view_options(token, port), limits, &cameras_),
        thread_([this] { server_.run(); }) {}
  ~ServedWorld() {
    server_.stop();
    thread_.join();
  }
  std::uint16_t port() const { return view_.port(); }
  std::uint16_t usarsim_port() const { return server_.port(); }
  std::string url() const { return view_.url(); }
  const image_server::Feed& cameras() const { return cameras_; }

 private:
  static world_server::ServerOptions server_options(const std::string& world) {
    world_server::ServerOptions options;
    options.world = world;
    options.port = 0;
    return options;
  }
  static ViewOptions view_options(const std::string& token, std::uint16_t port) {
    ViewOptions options;
    options.port = port;
    options.token = token;
    return options;
  }
  world_server::WorldServer server_;
  image_server::Feed cameras_;
  View view_;
  std::thread thread_;
};

}  // namespace kenaf::live
