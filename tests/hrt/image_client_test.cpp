// libkenaf_sim's camera client is tested below hrt_get_picture, against a server of pictures that the test speaks for
// byte by byte. The tests check the requests, the number, robot time and age that a picture states, and servers that
// know only USARSim's own protocol. Whatever a server does wrong ends in words, and the robot goes on.
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstring>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "kenaf/hrt.h"
#include "libkenaf_sim/image_client.hpp"
#include "tests/hrt/fake_image_server.hpp"
#include "tests/hrt/fake_transport.hpp"
#include "tests/hrt/name_servers.hpp"
#include "tests/support/loopback.hpp"

using namespace kenaf;
using namespace kenaf::hrt::test;
using namespace std::chrono_literals;
using Client = FakeImageServer::Connection;

namespace {

// A robot that stands by, whose cameras are at `server`.
struct OpenAt {
  explicit OpenAt(const std::string& server, double connect_timeout_s = 3,
                  const sim::AskForAddresses& ask = sim::ask_system)
      : robot(use_fake_robot()) {
    use_cameras([ask](const hrt_config& config, const std::string& camera) {
      return std::make_unique<sim::ImageClient>(config, camera, ask);
    });
    hrt_config config = hrt_config_default();
    std::memset(config.camera_server, 0, sizeof config.camera_server);
    server.copy(config.camera_server, sizeof config.camera_server - 1);
    config.connect_timeout_s = connect_timeout_s;
    REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  }
  ~OpenAt() { (void)hrt_close(); }
  std::shared_ptr<FakeRobot> robot;
};

unsigned char pixels[64 * 48 * 3];

int get(hrt_picture& picture, const char* camera = nullptr, double timeout_s = 20) {
  return hrt_get_picture(camera, HRT_PICTURE_RGB, pixels, sizeof pixels, timeout_s, &picture);
}

// A port whose queue of connections is full: the system leaves further ones without any answer.
class SilentListener {
 public:
  SilentListener() : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address = kenaf::test::loopback(0);
    socklen_t size = sizeof address;
    REQUIRE(::bind(listener_, reinterpret_cast<const sockaddr*>(&address), size) == 0);
    REQUIRE(::listen(listener_, 0) == 0);
    REQUIRE(::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) == 0);
    port_ = ntohs(address.sin_port);
    waiting_ = kenaf::test::connect_to_loopback(port_);  // a queue of 0 holds one
  }
  ~SilentListener() {
    ::close(waiting_);
    ::close(listener_);
  }
  SilentListener(const SilentListener&) = delete;
  SilentListener& operator=(const SilentListener&) = delete;
  std::uint16_t port() const { return port_; }

 private:
  int listener_, waiting_ = -1;
  std::uint16_t port_ = 0;
};

// Fails as it must, in these words, and the robot still moves.
void check_failure(const std::string& server, int code, const std::string& words, double connect_timeout_s = 3) {
  const OpenAt open(server, connect_timeout_s);
  hrt_picture picture = hrt_picture_init();
  CHECK(get(picture, "Camera") == code);
  CHECK_THAT(hrt_last_error(), Catch::Contains(words));
  CHECK(hrt_go_forward(10) == HRT_OK);
}

}  // namespace

TEST_CASE("A name is selected, then pictures are asked for one at a time, without a name 'J' is all that is sent") {
  std::mutex mutex;
  std::vector<std::string> heard;
  const Bytes8 red = plain_jpeg(64, 48, 200, 0, 0);
  FakeImageServer server([&](Client& connection) {
    std::uint64_t number = 0;
    while (const auto kind = connection.request()) {
      {
        const std::lock_guard lock(mutex);
        heard.push_back(*kind == 'V' ? "V " + connection.selected : std::string(1, *kind));
      }
      if (*kind == 'J') connection.answer(3, noted(red, {.number = ++number, .robot = "k", .camera = "Front"}));
    }
  });
  const OpenAt open(server.address());
  hrt_picture picture = hrt_picture_init();
  REQUIRE(get(picture) == HRT_OK);
  {
    const std::lock_guard lock(mutex);
    CHECK(heard.front() == "J");
    heard.clear();
  }
  REQUIRE(hrt_close() == HRT_OK);
  const hrt_config config = [&] {
    hrt_config other = hrt_config_default();
    std::memset(other.camera_server, 0, sizeof other.camera_server);
    server.address().copy(other.camera_server, sizeof other.camera_server - 1);
    return other;
  }();
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  picture = hrt_picture_init();
  REQUIRE(get(picture, "Kenaf 1/Front") == HRT_OK);
  const std::lock_guard lock(mutex);
  const auto select =
      std::find(heard.begin(), heard.end(), "V Kenaf 1/Front");  // before it: the first connection's last
  REQUIRE(heard.end() - select >= 2);
  CHECK(select[1] == "J");
}

TEST_CASE("Number, robot time, name and pixels are the server's, the age counts from the request at least") {
  const Bytes8 green = plain_jpeg(64, 48, 0, 180, 0);
  FakeImageServer server([&](Client& connection) {
    while (const auto kind = connection.request()) {
      std::this_thread::sleep_for(100ms);  // of which the server says nothing
      const protocol::image::FrameNote note{
          .number = 41, .robot_time_s = 12.25, .age_ms = 20, .robot = "a b", .camera = "BirdsEye"};
      connection.answer(1, noted(green, note));
    }
  });
  const OpenAt open(server.address());
  hrt_picture picture = hrt_picture_init();
  REQUIRE(get(picture) == HRT_OK);
  CHECK(picture.number == 41);
  CHECK(picture.time_s == 12.25);
  CHECK(std::string(picture.camera) == "BirdsEye");
  CHECK(picture.width == 64);
  CHECK(picture.height == 48);
  CHECK(picture.bytes == sizeof pixels);
  CHECK(picture.age_ms >= 120);  // 20 ms by the server, 100 ms since the request
  CHECK(picture.age_ms < 20'000);
  // JPEG of quality 80, one colour: a level or two of rounding.
  CHECK(int{pixels[0]} < 4);
  CHECK(std::abs(pixels[1] - 180) < 4);
  CHECK(int{pixels[2]} < 4);
  // It is the same again and again: no other one.
  CHECK(get(picture, nullptr, 0.3) == HRT_E_TIMEOUT);
}

TEST_CASE("The next picture is not requested long before it can be there") {
  const Bytes8 red = plain_jpeg(64, 48, 200, 0, 0);
  std::atomic<int> too_soon = 0, pictures = 0;
  FakeImageServer server([&](Client& connection) {
    // A camera of 20 Hz that answers when its next picture is there.
    auto due = std::chrono::steady_clock::now();
    std::uint64_t number = 0;
    for (auto answered = due; connection.request(); answered = std::chrono::steady_clock::now()) {
      if (number >= 2 && std::chrono::steady_clock::now() - answered < 20ms) ++too_soon;
      due = std::max(due + 50ms, std::chrono::steady_clock::now());
      std::this_thread::sleep_until(due);
      connection.answer(2, noted(red, {.number = ++number, .age_ms = 1, .robot = "k", .camera = "c"}));
      ++pictures;
    }
  });
  const OpenAt open(server.address());
  hrt_picture picture = hrt_picture_init();
  for (int i = 0; i < 12; ++i) REQUIRE(get(picture) == HRT_OK);
  // 0.8 of 50 ms after the one before; where the machine is held up, the time between two may be short for once.
  CHECK(too_soon <= pictures / 3);
}

TEST_CASE("A server that knows 'OK' alone is asked so after a second, its pictures are counted here") {
  std::atomic<int> asked = 0, selected = 0;
  const Bytes8 blue = plain_jpeg(64, 48, 0, 0, 180);
  FakeImageServer server([&](Client& connection) {
    while (const auto kind = connection.request()) {
      if (*kind == 'O') connection.answer(3, blue), ++asked;
      if (*kind == 'V') ++selected;
    }
  });
  const OpenAt open(server.address());
  hrt_picture picture = hrt_picture_init();
  for (const std::uint64_t number : {1u, 2u}) {
    REQUIRE(get(picture) == HRT_OK);
    CHECK(picture.number >= number);
    CHECK(picture.time_s == -1);
    CHECK(picture.age_ms == -1);
    CHECK(picture.camera[0] == '\0');
    CHECK(int{pixels[2]} > 170);
  }
  CHECK(asked >= 2);
  CHECK(selected == 0);
}

TEST_CASE("Raw pictures are blue, green, red, in rows of whole 4 bytes") {
  FakeImageServer server([&](Client& connection) {
    while (const auto kind = connection.request()) {
      // 1 x 2 pixels: 3 bytes and 1 of padding a row.
      if (*kind == 'O') connection.answer(0, {0, 1, 0, 2, 10, 20, 30, 0, 40, 50, 60, 0});
    }
  });
  const OpenAt open(server.address());
  hrt_picture picture = hrt_picture_init();
  REQUIRE(get(picture) == HRT_OK);
  CHECK(picture.width == 1);
  CHECK(picture.height == 2);
  CHECK(picture.bytes == 6);
  CHECK(std::vector<int>(pixels, pixels + 6) == std::vector<int>{30, 20, 10, 60, 50, 40});
}

TEST_CASE("A picture that a server sends unasked at the begin does not end the asking") {
  const Bytes8 grey = plain_jpeg(64, 48, 90, 90, 90);
  FakeImageServer server([&](Client& connection) {
    connection.answer(3, grey);
    while (const auto kind = connection.request())
      if (*kind == 'O') connection.answer(3, grey);
  });
  const OpenAt open(server.address());
  hrt_picture picture = hrt_picture_init();
  REQUIRE(get(picture) == HRT_OK);
  REQUIRE(get(picture) == HRT_OK);
}

TEST_CASE("A camera that there is not is an error in the server's words") {
  FakeImageServer server([](Client& connection) {
    const std::string words = "robot kenaf has no camera 'Camera'; it has:\nBirdsEye";
    while (const auto kind = connection.request())
      if (*kind == 'J') connection.answer(255, Bytes8(words.begin(), words.end()));
  });
  check_failure(server.address(), HRT_E_DEVICE,
                "camera 'Camera': robot kenaf has no camera 'Camera'; it has: BirdsEye");
}

TEST_CASE("Whatever else a server does wrong ends in words") {
  const Bytes8 jpeg = plain_jpeg(64, 48, 1, 2, 3);
  const auto misbehave = [&](const std::function<void(Client&)>& answer, const std::string& words) {
    FakeImageServer server([&](Client& connection) {
      while (const auto kind = connection.request())
        if (*kind != 'V') answer(connection);
    });
    check_failure(server.address(), HRT_E_LINK, words, 0.3);
  };
  misbehave(
      [](Client& c) {
        c.send({"\x03\x04\x00\x00\x01", 5});
      },
      "67108865 bytes, which is more than a picture can have");
  misbehave([](Client& c) { c.send("HTTP/1.1 400 Bad Request\r\n"); }, "type 72, which is not a picture");
  misbehave([&](Client& c) { c.answer(3, Bytes8(jpeg.begin(), jpeg.end() - 9)); }, "not a complete JPEG");
  misbehave([&](Client& c) { c.answer(3, {}); }, "not a complete JPEG");
  misbehave([](Client& c) { c.answer(0, {0, 9, 0, 9, 1, 2}); }, "raw picture of 6 bytes");
  misbehave([](Client&) {}, "says nothing");
  misbehave(
      [](Client& c) {
        c.send({"\x03\x00\x01\x00\x00\xff\xd8", 7});
      },
      "says nothing more in the middle of a picture");
  // announces all it may and sends a little: memory is for what came
  misbehave([](Client& c) { c.send({"\x03\x03\xff\xff\xff\xff\xd8", 7}); }, "says nothing more");
}

TEST_CASE("A server that goes away is named, and asked anew by the next call") {
  std::atomic<bool> serves = false;
  const Bytes8 red = plain_jpeg(64, 48, 200, 0, 0);
  FakeImageServer server([&](Client& connection) {
    if (!connection.request() || !serves) return;
    connection.answer(3, noted(red, {.number = 1, .robot = "k", .camera = "c"}));
    while (connection.request()) {
    }
  });
  const OpenAt open(server.address());
  hrt_picture picture = hrt_picture_init();
  CHECK(get(picture) == HRT_E_LINK);
  CHECK_THAT(hrt_last_error(), Catch::Contains("closed the connection; the next call reconnects"));
  serves = true;
  CHECK(get(picture) == HRT_OK);
  CHECK(server.connections() == 2);
}

TEST_CASE("A name server that does not answer holds up neither the program nor its end") {
  const SilentNameServer names;
  const OpenAt open("robot.example:5003", 60, names.ask());
  hrt_picture picture = hrt_picture_init();
  CHECK(get(picture, nullptr, 0.05) == HRT_E_TIMEOUT);
  CHECK(hrt_go_forward(10) == HRT_OK);
  CHECK(hrt_close() == HRT_OK);  // which would never return if it waited for the answer
}

TEST_CASE("A name server that does not answer is named after connect_timeout_s") {
  const SilentNameServer names;
  const OpenAt open("robot.example:5003", 0.1, names.ask());
  hrt_picture picture = hrt_picture_init();
  CHECK(get(picture) == HRT_E_LINK);
  CHECK_THAT(hrt_last_error(), Catch::Contains("robot.example:5003") && Catch::Contains("name server"));
}

TEST_CASE("Pictures come from the second address of a name whose first one is silent") {
  const SilentListener silent;
  const Bytes8 red = plain_jpeg(64, 48, 200, 0, 0);
  FakeImageServer server([&](Client& connection) {
    while (connection.request()) connection.answer(3, noted(red, {.number = 1, .robot = "k", .camera = "c"}));
  });
  const std::string address = server.address();
  const auto port = static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
  const OpenAt open("robot.example:5003", 1, name_of({{"127.0.0.1", silent.port()}, {"127.0.0.1", port}}));
  hrt_picture picture = hrt_picture_init();
  CHECK(get(picture) == HRT_OK);
}

TEST_CASE("A server that is not there, and an address that is none, are named") {
  std::string gone;
  {
    const FakeImageServer server([](Client&) {});
    gone = server.address();
  }
  check_failure(gone, HRT_E_LINK, "no server of camera pictures at " + gone);
  check_failure("localhost", HRT_E_CONFIG, "camera_server must be HOST:PORT");
  check_failure("[]:5003", HRT_E_CONFIG, "camera_server must be HOST:PORT");
}
