// Cameras of the real robot without one: what the description says, what is a whole picture, devices that are none. A
// driver of the kernel's is in tests/can/camera_test.sh.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "formats/description/description_error.hpp"
#include "hrt/error.hpp"
#include "libkenaf_real/camera_on_robot.hpp"
#include "libkenaf_real/v4l2_camera.hpp"

using namespace kenaf;
using namespace kenaf::real;
using Encoding = hrt::CameraPicture::Encoding;

namespace {

const std::string kFront = R"([[camera]]
name = "Front"
device = "/dev/video2"
width = 320
height = 180
rate_hz = 12.5
mount = "for the simulator"
)";
const std::string kMast = R"([[camera]]
name = "Mast"
width = 640
height = 480
rate_hz = 30
jpeg_quality = 60
)";

std::string error_of(const std::string& toml) {
  try {
    (void)parse_cameras(toml, "robot.toml");
  } catch (const description::DescriptionError& error) {
    return error.what();
  }
  return "";
}

std::string choice_error(const std::string& toml, const std::string& name) {
  try {
    (void)choose_camera(parse_cameras(toml, "robot.toml"), name, "my-robot");
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_DEVICE);
    return error.what();
  }
  return "";
}

std::string device_error(const std::string& device) {
  V4l2Camera camera(
      {.name = "Front", .device = device, .width = 320, .height = 180, .rate_hz = 10, .jpeg_quality = 80});
  try {
    camera.open();
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_DEVICE);
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("A description's cameras, with the keys that are the simulator's passed over") {
  const auto cameras = parse_cameras(kFront + kMast + "[body]\nmass_kg = 3\n", "robot.toml");
  REQUIRE(cameras.size() == 2);
  CHECK(cameras[0].name == "Front");
  CHECK(cameras[0].device == "/dev/video2");
  CHECK(cameras[0].width == 320);
  CHECK(cameras[0].height == 180);
  CHECK(cameras[0].rate_hz == 12.5);
  CHECK(cameras[0].jpeg_quality == 80);
  CHECK(cameras[1].device.empty());
  CHECK(cameras[1].jpeg_quality == 60);
  CHECK(parse_cameras("", "robot.toml").empty());
  CHECK(load_cameras("kenaf").size() == 2);
}

TEST_CASE("What is wrong with a camera is named with its place") {
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
  };
  CHECK_THAT(error_of(with(kFront, "/dev/video2", "video2")),
             Catch::Contains("robot.toml:3:") && Catch::Contains("path of a video device"));
  CHECK_THAT(error_of(with(kFront, "320", "3.5")), Catch::StartsWith("robot.toml:4:"));
  CHECK_THAT(error_of(with(kFront, "12.5", "0")), Catch::StartsWith("robot.toml:6:"));
  CHECK_THAT(error_of(kFront + kFront), Catch::Contains("name of another camera"));
  CHECK_THAT(error_of(kFront + with(kFront, "Front", "Rear")), Catch::Contains("device of another camera"));
}

TEST_CASE("A camera is chosen by name, without a name the first, else it is said what there is") {
  const auto cameras = parse_cameras(kFront + kMast, "robot.toml");
  CHECK(choose_camera(cameras, "", "r").name == "Front");
  CHECK(choose_camera(cameras, "Front", "r").name == "Front");
  CHECK(choice_error(kFront + kMast, "Rear") == "robot 'my-robot' has no camera 'Rear'; it has: Front, Mast");
  CHECK_THAT(choice_error(kFront + kMast, "Mast"),
             Catch::Contains("camera 'Mast' of robot 'my-robot' has no device: add device"));
  CHECK_THAT(choice_error("", ""), Catch::Contains("robot 'my-robot' has no camera"));
}

TEST_CASE("A buffer's picture: rows without their padding, Motion JPEG as it is, nothing where it is not whole") {
  // 2 x 2 pixels of YUYV: 4 bytes a row, 6 from row to row; the last row may end without padding
  const std::vector<std::uint8_t> padded{1, 2, 3, 4, 0, 0, 5, 6, 7, 8};
  CHECK(bytes_of_buffer(Encoding::yuyv, 2, 2, 6, padded) == std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8});
  CHECK_FALSE(bytes_of_buffer(Encoding::yuyv, 2, 2, 6, std::span(padded).first(9)));
  CHECK_FALSE(bytes_of_buffer(Encoding::yuyv, 2, 2, 3, padded));
  const std::vector<std::uint8_t> jpeg{0xff, 0xd8, 1, 2, 0xff, 0xd9, 0, 0};
  CHECK(bytes_of_buffer(Encoding::jpeg, 320, 180, 0, jpeg) == jpeg);
  CHECK_FALSE(bytes_of_buffer(Encoding::jpeg, 320, 180, 0, std::span(jpeg).first(5)));
  CHECK_FALSE(bytes_of_buffer(Encoding::jpeg, 320, 180, 0, {}));
}

TEST_CASE("A device that is not there, or is none, is named") {
  CHECK_THAT(device_error("/dev/video-of-nobody"),
             Catch::Contains("camera 'Front': /dev/video-of-nobody does not exist"));
  CHECK_THAT(device_error("/dev/null"), Catch::Contains("/dev/null is not a video device"));
}
