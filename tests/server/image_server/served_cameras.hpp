// A world server with its cameras, on free ports, in threads of this process; and a client that has a robot in it.
#pragma once

#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>

#include "server/image_server/feed.hpp"
#include "server/image_server/image_server.hpp"
#include "server/world_server/world_server.hpp"
#include "tests/support/patience.hpp"
#include "tests/support/usarsim_client.hpp"

namespace kenaf::image_server {

struct CameraWorld {
  static world_server::ServerOptions options(const std::string& world, double speed) {
    world_server::ServerOptions options;
    options.world = world;
    options.port = 0;
    options.speed = speed;
    return options;
  }
  explicit CameraWorld(const std::string& world = "flat", double speed = 1, ImageType type = ImageType::good,
                       const ImageServerLimits& limits = {})
      : server(options(world, speed)),
        feed(server),
        images(feed, "127.0.0.1", 0, type, limits),
        thread([this] { server.run(); }) {}
  ~CameraWorld() {
    server.stop();
    thread.join();
  }
  std::uint16_t port() const { return images.port(); }

  world_server::WorldServer server;
  Feed feed;
  ImageServer images;
  std::thread thread;
};

// A client of the world server with a robot.
struct Robot {
  Robot(CameraWorld& world, const std::string& name, const std::string& location = "0,0,0",
        const std::string& class_name = "Kenaf")
      : client(world.server.port()) {
    client.send("INIT {ClassName USARBot." + class_name + "} {Name " + name + "} {Location " + location + "}\r\n");
    client.line_that_begins("STA");
  }
  // A request that is answered.
  void ask(const std::string& request) {
    client.send(request + "\r\n");
    if (const std::string answer = client.line_that_begins("RES"); answer.find("{Status OK}") == std::string::npos) {
      throw std::runtime_error(answer);
    }
  }
  support::UsarsimClient client;
};

}  // namespace kenaf::image_server
