// A program's pictures from kenaf-world's cameras, by libkenaf_sim through relay and image server.
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "kenaf/hrt.h"
#include "tests/system/chain.hpp"

using kenaf::system_test::Chain;

namespace {

struct OpenChain {
  explicit OpenChain(const Chain& chain) {
    hrt_config config = hrt_config_default();
    const auto set = [](char* member, std::size_t size, std::uint16_t port) {
      std::memset(member, 0, size);
      ("127.0.0.1:" + std::to_string(port)).copy(member, size - 1);
    };
    set(config.relay, sizeof config.relay, chain.relay_port());
    set(config.camera_server, sizeof config.camera_server, chain.camera_port());
    const int result = hrt_kenaf_init_with(&config);
    INFO(hrt_last_error());
    REQUIRE(result == HRT_OK);
  }
  ~OpenChain() { (void)hrt_close(); }
};

using Pixels = std::vector<unsigned char>;

Pixels look(const char* camera, hrt_picture& picture) {
  Pixels pixels(640 * 480 * 3);
  const int result = hrt_get_picture(camera, HRT_PICTURE_RGB, pixels.data(), pixels.size(), 60, &picture);
  INFO(hrt_last_error());
  REQUIRE(result == HRT_OK);
  return pixels;
}

double mean_difference(const Pixels& a, const Pixels& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

hrt_state drive() {
  REQUIRE(hrt_go_forward(100) == HRT_OK);
  REQUIRE(hrt_turning(45) == HRT_OK);
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_get_state(&state) == HRT_OK);
  return state;
}

}  // namespace

TEST_CASE("A program sees through both of Kenaf's cameras, and what it sees turns with the robot") {
  const Chain chain("1", "step-200", true);
  const OpenChain open(chain);
  hrt_picture front = hrt_picture_init(), above = hrt_picture_init();
  const Pixels ahead = look(nullptr, front), down = look("BirdsEye", above);
  for (const hrt_picture* picture : {&front, &above}) {
    CHECK(picture->width == 640);
    CHECK(picture->height == 480);
    CHECK(picture->number >= 1);
    CHECK(picture->time_s >= 0);
    CHECK(picture->time_s <= hrt_time());
    CHECK(picture->age_ms >= 20);  // the latency of the description
  }
  CHECK(std::string(front.camera) == "Camera");
  CHECK(std::string(above.camera) == "BirdsEye");
  CHECK(mean_difference(ahead, down) > 5);

  // Each once; at whole multiples of a thirtieth of a second of robot time, but for the first one, which is taken at
  // once.
  (void)look(nullptr, front);
  for (int i = 0; i < 5; ++i) {
    const hrt_picture before = front;
    const Pixels again = look(nullptr, front);
    CHECK(front.number > before.number);
    const double periods = (front.time_s - before.time_s) * 30;
    CHECK(std::round(periods) >= 1);
    // A picture is taken at the first step at or after its time; steps are 1 ms.
    CHECK(std::abs(periods - std::round(periods)) <= 0.031);
    CHECK(mean_difference(ahead, again) < 1);  // it stands
  }
  REQUIRE(hrt_turning(45) == HRT_OK);
  // The newest one may still be of the turn's end: until it shows the robot standing.
  const double stood_s = hrt_time();
  Pixels turned = look(nullptr, front);
  while (front.time_s < stood_s) turned = look(nullptr, front);
  CHECK(mean_difference(ahead, turned) > 5);

  // The step is 1 m ahead of the start; JPEG is the file as the server sent it.
  Pixels file(1 << 20);
  REQUIRE(hrt_get_picture("Camera", HRT_PICTURE_JPEG, file.data(), file.size(), 60, &front) == HRT_OK);
  CHECK(int{file[0]} == 0xff);
  CHECK(int{file[1]} == 0xd8);
  CHECK(std::string(file.begin() + 6, file.begin() + 20) == "kenaf-frame/1 ");

  hrt_picture none = hrt_picture_init();
  CHECK(hrt_get_picture("Periscope", HRT_PICTURE_RGB, file.data(), file.size(), 60, &none) == HRT_E_DEVICE);
  CHECK_THAT(hrt_last_error(), Catch::Contains("Periscope") && Catch::Contains("BirdsEye"));
}

TEST_CASE("A program that takes pictures all the while drives the same path, to the last bit") {
  const Chain chain("0", "flat", true);
  hrt_state without = hrt_state_init();
  {
    const OpenChain open(chain);
    without = drive();
  }
  const OpenChain open(chain);
  std::atomic<bool> drives = true;
  std::atomic<int> pictures = 0;
  std::thread watcher([&] {
    Pixels pixels(640 * 480 * 3);
    hrt_picture picture = hrt_picture_init();
    while (drives)
      if (hrt_get_picture("Camera", HRT_PICTURE_RGB, pixels.data(), pixels.size(), 0.2, &picture) == HRT_OK) ++pictures;
  });
  const hrt_state with = drive();
  while (pictures < 2) std::this_thread::yield();
  drives = false;
  watcher.join();
  CHECK(with.pose_x_mm == without.pose_x_mm);
  CHECK(with.pose_y_mm == without.pose_y_mm);
  CHECK(with.pose_yaw_deg == without.pose_yaw_deg);
  CHECK(with.lost_cycles == 0);
}
