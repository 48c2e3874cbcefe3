// These tests use hrt_get_picture from outside, with cameras whose pictures are known. They check the bytes that are
// written, which picture a call returns and how long it waits for it, wrong arguments, and cameras that fail. Pictures
// must not disturb the cycle: a program that asks for none pays nothing, and one that stops asking ceases to pay.
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "hrt/error.hpp"
#include "hrt/picture_codec.hpp"
#include "kenaf/hrt.h"
#include "tests/hrt/fake_image_server.hpp"
#include "tests/hrt/fake_transport.hpp"
#include "tests/support/patience.hpp"

using namespace kenaf::hrt;
using namespace kenaf::hrt::test;
using namespace std::chrono_literals;

namespace {

// What a fake camera shows, from now on.
struct Scene {
  std::mutex mutex;
  std::condition_variable changed;
  CameraPicture picture;  // number 0: there is none yet
  std::uint64_t given = 0;
  std::optional<Error> failure;
  int opened = 0, closed = 0, pauses = 0;
  std::string name;

  void show(CameraPicture next) {
    const std::lock_guard lock(mutex);
    next.number = picture.number + 1;
    picture = std::move(next);
    changed.notify_all();
  }
  void fail(std::optional<Error> with) {
    const std::lock_guard lock(mutex);
    failure = std::move(with);
    changed.notify_all();
  }
  template <typename Condition>
  void await(const Condition& condition) {
    std::unique_lock lock(mutex);
    REQUIRE(changed.wait_for(lock, kenaf::support::patience(), condition));
  }
};

class FakeCamera final : public Camera {
 public:
  FakeCamera(std::shared_ptr<Scene> scene, const std::string& name) : scene_(std::move(scene)) { scene_->name = name; }
  ~FakeCamera() override {
    const std::lock_guard lock(scene_->mutex);
    ++scene_->closed;
  }
  void open() override {
    const std::lock_guard lock(scene_->mutex);
    ++scene_->opened;
    scene_->changed.notify_all();
  }
  std::optional<CameraPicture> next() override {
    std::unique_lock lock(scene_->mutex);
    scene_->changed.wait(lock,
                         [&] { return interrupted_ || scene_->failure || scene_->picture.number != scene_->given; });
    if (interrupted_) return std::nullopt;
    if (scene_->failure) throw *scene_->failure;
    scene_->given = scene_->picture.number;
    return scene_->picture;
  }
  void pause() override {
    const std::lock_guard lock(scene_->mutex);
    ++scene_->pauses;
    scene_->changed.notify_all();
  }
  void interrupt() override {
    const std::lock_guard lock(scene_->mutex);
    interrupted_ = true;
    scene_->changed.notify_all();
  }

 private:
  std::shared_ptr<Scene> scene_;
  bool interrupted_ = false;
};

struct OpenScene {
  explicit OpenScene(bool lockstep = true) : robot(use_fake_robot()), scene(std::make_shared<Scene>()) {
    robot->lockstep = lockstep;
    robot->runs_alone = !lockstep;
    use_cameras([scene = scene](const hrt_config&, const std::string& name) {
      return std::make_unique<FakeCamera>(scene, name);
    });
    const hrt_config config = hrt_config_default();
    REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  }
  ~OpenScene() { (void)hrt_close(); }
  std::shared_ptr<FakeRobot> robot;
  std::shared_ptr<Scene> scene;
};

// 2 x 2 pixels: red, green; blue, white.
CameraPicture four_pixels() {
  CameraPicture picture;
  picture.encoding = CameraPicture::Encoding::rgb;
  picture.width = picture.height = 2;
  picture.camera = "Camera";
  picture.bytes = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
  return picture;
}

CameraPicture jpeg_picture(Bytes8 bytes) {
  CameraPicture picture;
  picture.bytes = std::move(bytes);
  return picture;
}

unsigned char room[1 << 16];

int get_rgb(hrt_picture& picture, double timeout_s = 20) {
  return hrt_get_picture(nullptr, HRT_PICTURE_RGB, room, sizeof room, timeout_s, &picture);
}

}  // namespace

TEST_CASE("RGB is what the camera gave, rows from the top") {
  const OpenScene open;
  open.scene->show(four_pixels());
  hrt_picture picture = hrt_picture_init();
  REQUIRE(hrt_get_picture("Camera", HRT_PICTURE_RGB, room, 12, 20, &picture) == HRT_OK);
  CHECK(open.scene->name == "Camera");
  CHECK(picture.format == HRT_PICTURE_RGB);
  CHECK(picture.width == 2);
  CHECK(picture.height == 2);
  CHECK(picture.number == 1);
  CHECK(picture.bytes == 12);
  CHECK(picture.time_s == -1);
  CHECK(picture.age_ms == -1);
  CHECK(std::string(picture.camera) == "Camera");
  CHECK(std::vector<int>(room, room + 12) == std::vector<int>{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255});
}

TEST_CASE("A camera's own JPEG is handed on byte by byte, and decoded for RGB") {
  const OpenScene open;
  const Bytes8 jpeg = plain_jpeg(40, 30, 10, 200, 90);
  open.scene->show(jpeg_picture(jpeg));
  hrt_picture picture = hrt_picture_init();
  REQUIRE(hrt_get_picture("", HRT_PICTURE_JPEG, room, sizeof room, 20, &picture) == HRT_OK);
  CHECK(picture.format == HRT_PICTURE_JPEG);
  CHECK(picture.width == 40);
  CHECK(picture.height == 30);
  CHECK(Bytes8(room, room + picture.bytes) == jpeg);
  picture = hrt_picture_init();
  REQUIRE(get_rgb(picture) == HRT_OK);
  REQUIRE(picture.bytes == 3600);
  for (std::size_t i = 0; i < picture.bytes; i += 3) {
    REQUIRE(std::abs(room[i] - 10) < 4);
    REQUIRE(std::abs(room[i + 1] - 200) < 4);
    REQUIRE(std::abs(room[i + 2] - 90) < 4);
  }
}

TEST_CASE("A webcam's Motion JPEG, which leaves out the standard Huffman tables, is decoded") {
  const OpenScene open;
  Bytes8 jpeg = plain_jpeg(32, 32, 10, 200, 90);
  // Without its segments DHT (FF C4), which TurboJPEG writes where they are the standard's.
  int dropped = 0;
  for (std::size_t at = 2; jpeg[at + 1] != 0xda;) {
    const std::size_t bytes = std::size_t{2} + jpeg[at + 2] * 256u + jpeg[at + 3];
    if (jpeg[at + 1] != 0xc4) {
      at += bytes;
      continue;
    }
    jpeg.erase(jpeg.begin() + static_cast<std::ptrdiff_t>(at), jpeg.begin() + static_cast<std::ptrdiff_t>(at + bytes));
    ++dropped;
  }
  CHECK(dropped > 0);
  open.scene->show(jpeg_picture(jpeg));
  hrt_picture picture = hrt_picture_init();
  REQUIRE(get_rgb(picture) == HRT_OK);
  CHECK(std::abs(room[0] - 10) < 4);
  CHECK(std::abs(room[1] - 200) < 4);
  CHECK(std::abs(room[2] - 90) < 4);
}

TEST_CASE("YUYV is converted by BT.601, to RGB and to JPEG") {
  const OpenScene open;
  CameraPicture yuyv;
  yuyv.encoding = CameraPicture::Encoding::yuyv;
  yuyv.width = 16;
  yuyv.height = 16;
  // Colour bars of BT.601 at 100 %: white 235 128 128, black 16 128 128; red 81 90 240 (Y = 16 + 65.5, U = 128 - 37.8,
  // V = 240).
  for (int pair = 0; pair < 8 * 16; ++pair) {
    const Bytes8 white_black{235, 128, 16, 128}, red{81, 90, 81, 240};
    const Bytes8& of_row = pair < 8 * 8 ? white_black : red;
    yuyv.bytes.insert(yuyv.bytes.end(), of_row.begin(), of_row.end());
  }
  open.scene->show(yuyv);
  hrt_picture picture = hrt_picture_init();
  REQUIRE(get_rgb(picture) == HRT_OK);
  REQUIRE(picture.bytes == 16 * 16 * 3);
  CHECK(std::vector<int>(room, room + 6) == std::vector<int>{255, 255, 255, 0, 0, 0});
  const unsigned char* last = room + picture.bytes - 3;
  CHECK(int{last[0]} >= 253);
  CHECK(int{last[1]} <= 1);
  CHECK(int{last[2]} <= 1);
  picture = hrt_picture_init();
  REQUIRE(hrt_get_picture(nullptr, HRT_PICTURE_JPEG, room, sizeof room, 20, &picture) == HRT_OK);
  const CameraPicture again = jpeg_picture(Bytes8(room, room + picture.bytes));
  REQUIRE(picture_size(again).width == 16);
  Bytes8 rgb(16 * 16 * 3);
  write_rgb(again, rgb);
  CHECK(int{rgb[rgb.size() - 3]} > 240);  // the last pixel is still red
  CHECK(int{rgb[rgb.size() - 2]} < 16);
}

TEST_CASE("A picture tells its robot time and its age") {
  const OpenScene open(false);  // a robot that waits for nobody, as the real one
  REQUIRE(hrt_wait_cycle(nullptr) == HRT_OK);
  CameraPicture picture = four_pixels();
  picture.exposed_at = std::chrono::steady_clock::now() - 250ms;
  open.scene->show(picture);
  hrt_picture got = hrt_picture_init();
  const auto before = std::chrono::steady_clock::now();
  const double before_s = hrt_time();
  REQUIRE(get_rgb(got) == HRT_OK);
  CHECK(got.age_ms >= 250);
  CHECK(got.age_ms < 20'000);
  // Its exposure was age_ms ago by the wall clock, whatever the robot's clock (which here counts 10 ms a millisecond)
  // says meanwhile.
  CHECK(got.time_s >= before_s - got.age_ms / 1e3 - 0.001);
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  CHECK(got.time_s <= hrt_time() - 0.25 + 0.01 + took_s);
  picture.robot_time_s = 7.5;  // a camera that knows it
  open.scene->show(picture);
  REQUIRE(get_rgb(got) == HRT_OK);
  CHECK(got.time_s == 7.5);
}

TEST_CASE("Each picture once, always the newest, and 0 for any") {
  const OpenScene open;
  hrt_picture picture = hrt_picture_init();
  CHECK(get_rgb(picture, 0) == HRT_E_TIMEOUT);
  CHECK_THAT(hrt_last_error(), Catch::Contains("no first picture of the first camera within 0 s"));
  open.scene->show(four_pixels());
  REQUIRE(get_rgb(picture) == HRT_OK);
  CHECK(picture.number == 1);
  const hrt_picture before = picture;
  CHECK(get_rgb(picture, 0) == HRT_E_TIMEOUT);
  CHECK(get_rgb(picture, 0.05) == HRT_E_TIMEOUT);
  CHECK(std::memcmp(&picture, &before, sizeof picture) == 0);
  picture.number = 0;
  CHECK(get_rgb(picture, 0) == HRT_OK);
  CHECK(picture.number == 1);
  std::thread later([&] {
    std::this_thread::sleep_for(120ms);
    open.scene->show(four_pixels());
  });
  CHECK(get_rgb(picture) == HRT_OK);
  CHECK(picture.number == 2);
  later.join();
}

TEST_CASE("Threads get their pictures each for itself") {
  const OpenScene open;
  std::atomic<int> wrong = 0;
  std::atomic<std::uint64_t> seen[3] = {0, 0, 0};
  std::vector<std::thread> readers;
  for (int reader = 0; reader < 3; ++reader) {
    readers.emplace_back([&, reader] {
      unsigned char own[12];
      hrt_picture picture = hrt_picture_init();
      for (std::uint64_t number = 1; number <= 20; ++number) {
        if (hrt_get_picture(nullptr, HRT_PICTURE_RGB, own, sizeof own, 20, &picture) != HRT_OK ||
            picture.number != number)
          ++wrong;
        seen[reader] = picture.number;
      }
    });
  }
  for (std::uint64_t number = 1; number <= 20; ++number) {
    open.scene->show(four_pixels());
    for (const auto& reader : seen)
      while (reader != number && wrong == 0) std::this_thread::sleep_for(100us);
  }
  for (std::thread& reader : readers) reader.join();
  CHECK(wrong == 0);
}

TEST_CASE("A buffer that is too small is told the size, and the picture is not lost") {
  const OpenScene open;
  open.scene->show(four_pixels());
  hrt_picture picture = hrt_picture_init();
  CHECK(hrt_get_picture(nullptr, HRT_PICTURE_RGB, nullptr, 0, 20, &picture) == HRT_E_ARGUMENT);
  CHECK_THAT(hrt_last_error(), Catch::Contains("needs 12 bytes (see picture->bytes), but capacity is 0"));
  CHECK(picture.bytes == 12);
  CHECK(picture.width == 2);
  CHECK(picture.number == 0);
  room[11] = room[12] = 77;
  CHECK(hrt_get_picture(nullptr, HRT_PICTURE_RGB, room, 11, 20, &picture) == HRT_E_ARGUMENT);
  CHECK(int{room[11]} == 77);
  CHECK(hrt_get_picture(nullptr, HRT_PICTURE_RGB, room, 12, 20, &picture) == HRT_OK);
  CHECK(int{room[12]} == 77);
  CHECK(picture.number == 1);
}

TEST_CASE("Wrong arguments are refused") {
  hrt_picture picture = hrt_picture_init();
  CHECK(get_rgb(picture) == HRT_E_NOT_INITIALISED);
  const OpenScene open;
  open.scene->show(four_pixels());
  CHECK(hrt_get_picture(nullptr, HRT_PICTURE_RGB, room, sizeof room, 1, nullptr) == HRT_E_ARGUMENT);
  CHECK(hrt_get_picture(nullptr, 2, room, sizeof room, 1, &picture) == HRT_E_ARGUMENT);
  CHECK(hrt_get_picture(nullptr, HRT_PICTURE_RGB, nullptr, 1, 1, &picture) == HRT_E_ARGUMENT);
  CHECK(hrt_get_picture(std::string(64, 'x').c_str(), HRT_PICTURE_RGB, room, sizeof room, 1, &picture) ==
        HRT_E_ARGUMENT);
  CHECK_THAT(hrt_last_error(), Catch::Contains("longer than 63 bytes"));
  for (const double timeout_s : {-1.0, 61.0, std::nan("")}) CHECK(get_rgb(picture, timeout_s) == HRT_E_ARGUMENT);
  hrt_picture zero;
  std::memset(&zero, 0, sizeof zero);
  CHECK(get_rgb(zero) == HRT_E_ARGUMENT);
  CHECK_THAT(hrt_last_error(), Catch::Contains("hrt_picture_init()"));
}

TEST_CASE("A camera that fails says so once, is opened anew by the next call, and the robot goes on") {
  const OpenScene open;
  open.scene->show(four_pixels());
  hrt_picture picture = hrt_picture_init();
  REQUIRE(get_rgb(picture) == HRT_OK);
  open.scene->fail(Error(HRT_E_DEVICE, "unplugged by the test"));
  CHECK(get_rgb(picture) == HRT_E_DEVICE);
  CHECK(std::string(hrt_last_error()) == "unplugged by the test");
  CHECK(hrt_go_forward(10) == HRT_OK);
  open.scene->fail(std::nullopt);
  open.scene->show(four_pixels());
  CHECK(get_rgb(picture) == HRT_OK);
  CHECK(open.scene->opened == 2);
  CHECK(open.scene->closed == 1);
}

TEST_CASE("A damaged picture is refused in words, and the next one is taken") {
  const OpenScene open;
  Bytes8 cut = plain_jpeg(640, 480, 10, 20, 30);
  cut.resize(cut.size() / 2);
  hrt_picture picture = hrt_picture_init();
  open.scene->show(jpeg_picture(cut));
  CHECK(get_rgb(picture) == HRT_E_ARGUMENT);  // 640 x 480 do not fit into `room`
  Bytes8 whole(640 * 480 * 3);
  CHECK(hrt_get_picture(nullptr, HRT_PICTURE_RGB, whole.data(), whole.size(), 20, &picture) == HRT_E_DEVICE);
  CHECK_THAT(hrt_last_error(), Catch::Contains("picture 1 of the camera is damaged"));
  open.scene->show(jpeg_picture({1, 2, 3}));
  CHECK(get_rgb(picture) == HRT_E_DEVICE);
  // 20,000 x 20,000 pixels in a header of a JPEG of 16 x 16: SOF0's height and width.
  Bytes8 boast = plain_jpeg(16, 16, 1, 2, 3);
  for (std::size_t i = 0; i + 9 < boast.size(); ++i) {
    if (boast[i] != 0xff || boast[i + 1] != 0xc0) continue;
    boast[i + 5] = boast[i + 7] = 0x4e;
    boast[i + 6] = boast[i + 8] = 0x20;
    break;
  }
  open.scene->show(jpeg_picture(boast));
  CHECK(get_rgb(picture) == HRT_E_DEVICE);
  CHECK_THAT(hrt_last_error(), Catch::Contains("claims 20000 x 20000 pixels"));
  open.scene->show(four_pixels());
  CHECK(get_rgb(picture) == HRT_OK);
  CHECK(picture.number == 4);
}

TEST_CASE("Robot time runs on while a picture is waited for, track speeds hold, hrt_stop ends nothing") {
  const OpenScene open;
  REQUIRE(hrt_set_tracks(100, 100) == HRT_OK);
  const double start_s = hrt_time();
  std::thread other([&] {
    while (hrt_time() < start_s + 1) std::this_thread::sleep_for(1ms);  // ten times command_timeout_s
    hrt_state state = hrt_state_init();
    CHECK(hrt_get_state(&state) == HRT_OK);
    CHECK(state.commanded_track_mmps[HRT_LEFT] == Approx(100));
    CHECK(hrt_stop() == HRT_OK);
    std::this_thread::sleep_for(20ms);
    open.scene->show(four_pixels());
  });
  hrt_picture picture = hrt_picture_init();
  CHECK(get_rgb(picture) == HRT_OK);
  other.join();
}

TEST_CASE("hrt_close ends a wait, and so does a link that breaks") {
  {
    const OpenScene open;
    std::thread closer([&] {
      open.scene->await([&] { return open.scene->opened == 1; });  // for the call below
      CHECK(hrt_close() == HRT_OK);
    });
    hrt_picture picture = hrt_picture_init();
    CHECK(get_rgb(picture) == HRT_E_CLOSED);
    closer.join();
  }
  const OpenScene open(false);
  {
    const std::lock_guard lock(open.robot->mutex);
    open.robot->lost_at_frame = 300;
  }
  hrt_picture picture = hrt_picture_init();
  CHECK(get_rgb(picture) == HRT_E_LINK);
  CHECK_THAT(hrt_last_error(), Catch::Contains("the fake link broke"));
}

TEST_CASE("A camera is opened for a picture only, and one that is not asked any more is told to pause") {
  const OpenScene open;
  REQUIRE(hrt_go_forward(10) == HRT_OK);
  CHECK(open.scene->opened == 0);
  open.scene->show(four_pixels());
  hrt_picture picture = hrt_picture_init();
  REQUIRE(get_rgb(picture) == HRT_OK);
  std::this_thread::sleep_for(2100ms);  // CameraStream::kIdleAfter
  open.scene->show(four_pixels());      // the camera's last answer, of the time in which nobody asked
  open.scene->await([&] { return open.scene->pauses == 1; });
  CHECK(get_rgb(picture, 0) == HRT_E_TIMEOUT);  // it is old by now
  open.scene->show(four_pixels());
  CHECK(get_rgb(picture) == HRT_OK);
  CHECK(picture.number == 3);
}
