#include "server/image_server/image_server.hpp"

#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "tests/server/image_server/image_client.hpp"
#include "tests/server/image_server/served_cameras.hpp"

namespace kenaf::image_server {

TEST_CASE("A reader that opens with another protocol is let go, and what it asks for in it is not drawn", "[hostile]") {
  CameraWorld world;
  Robot robot(world, "R1");
  ImageClient client(world.port());
  for (const std::string opening : {"POST / HTTP/1.1\r\nHost: 127.0.0.1:5003\r\n\r\nOKJ", "GET /OK HTTP/1.1\r\n\r\n",
                                    "\x16\x03\x01\x02", "SSH-2.0-OpenSSH_9.2\r\nOK"}) {
    ImageClient foreign(world.port());
    foreign.send(opening);
    CHECK_THROWS(foreign.read());
    CHECK(client.ask().type == 2);
  }
}

TEST_CASE("Idle readers give way when all connections are taken, and those that wait for a picture do not",
          "[hostile]") {
  ImageServerLimits limits;
  limits.connections = 4;
  limits.idle_s = 0;
  CameraWorld world("flat", 1, ImageType::good, limits);
  // Without a robot there is no picture: who knows the words is told so at once, and who does not waits.
  std::vector<std::unique_ptr<ImageClient>> readers;
  const auto come = [&] {
    readers.push_back(std::make_unique<ImageClient>(world.port()));
    return readers.back()->ask("J").type;
  };
  for (int i = 0; i < 30; ++i) CHECK(come() == 255);
  ImageClient a(world.port()), b(world.port()), c(world.port());
  for (ImageClient* client : {&a, &b, &c}) client->send("OK");
  for (int i = 0; i < 30; ++i) CHECK(come() == 255);
  Robot robot(world, "R1");
  for (ImageClient* client : {&a, &b, &c}) CHECK(client->read().type == 2);
}

}  // namespace kenaf::image_server
