#include "relayd/embedded_world.hpp"

namespace kenaf::relayd {

namespace {

world_server::ServerOptions server_options(const EmbeddedWorld& options) {
  world_server::ServerOptions out;
  out.world = options.world;
  out.robot = options.robot;
  out.speed = options.speed;
  out.listen_address = "127.0.0.1";
  out.port = 0;
  return out;
}

live::ViewOptions view_options(const EmbeddedWorld& options) {
  live::ViewOptions out = options.view;
  out.program = "kenaf-relayd --embedded";
  return out;
}

}  // namespace

EmbeddedWorldServer::EmbeddedWorldServer(const EmbeddedWorld& options)
    : server_(server_options(options)),
      cameras_(image_server::open_cameras(server_, options.cameras, "127.0.0.1")),
      view_(live::open_view(server_, view_options(options), cameras_.feed.get())),
      thread_([this] { server_.run(); }) {}

EmbeddedWorldServer::~EmbeddedWorldServer() {
  server_.stop();
  thread_.join();
}

}  // namespace kenaf::relayd
