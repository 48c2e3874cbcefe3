#include "server/image_server/frame.hpp"

#include <catch2/catch.hpp>

#include "camera/jpeg.hpp"
#include "tests/server/image_server/image_client.hpp"

namespace kenaf::image_server {

TEST_CASE("A JPEG says which frame it is and how old, and is the same picture") {
  Frame frame;
  frame.robot = "Robot 7";
  frame.camera = "Camera";
  frame.number = 12345678901;
  frame.robot_time_s = 1.0 / 3;
  camera::JpegEncoder encoder;
  const camera::Picture picture{32, 16, std::vector<std::uint8_t>(3 * 32 * 16, 200)};
  const auto jpeg = encoder.encode(picture, 90);
  frame.image = std::make_shared<CameraImage>(CameraImage{picture, {jpeg.begin(), jpeg.end()}});

  const std::string start = stamped_start(frame, 0.0212345);
  CHECK(start.substr(6) ==
        "kenaf-frame/1 number=12345678901 robot_time_s=0.333333 age_ms=21.235 robot=Robot 7 camera=Camera");
  std::vector<std::uint8_t> sent(start.begin(), start.end());
  const auto rest = after_start(frame.image->jpeg);
  sent.insert(sent.end(), rest.begin(), rest.end());
  CHECK(camera::decode_jpeg(sent).rgb == camera::decode_jpeg(frame.image->jpeg).rgb);
  const auto stamp = stamp_of(sent);
  REQUIRE(stamp);
  CHECK(stamp->number == frame.number);
  CHECK(stamp->robot == "Robot 7");
  CHECK(stamp->camera == "Camera");

  frame.robot = std::string(100000, 'x');
  CHECK(stamped_start(frame, 0).size() < 400);
}

}  // namespace kenaf::image_server
