// A decoded picture differs from the encoded one by a mean error that its quality bounds and that falls as the quality
// rises. The encoder refuses a quality out of range, and the decoder refuses bytes that are no JPEG.
#include <catch2/catch.hpp>

#include "camera/jpeg.hpp"
#include "tests/camera/scenes.hpp"

using namespace kenaf::camera;

namespace {

double mean_error(const Picture& a, const Picture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(a.rgb[i] - b.rgb[i]);
  return sum / static_cast<double>(a.rgb.size());
}

}  // namespace

TEST_CASE("A picture survives JPEG within a few levels, fewer the higher the quality") {
  const auto world = world_of("step-200");
  WorldSnapshot snapshot = snapshot_of(world);
  snapshot.robots.push_back(kenaf_at(pose(0, 0, 0.09)));
  const RobotSnapshot& robot = snapshot.robots[0];
  const Picture picture =
      picture_of(world, snapshot, camera_view(robot, *find_camera(*robot.description, "BirdsEye"), 1.4));
  JpegEncoder encoder;
  const auto file = encoder.encode(picture, 80);
  CHECK(file.size() < 100'000);
  CHECK(file[0] == 0xff);
  CHECK(file[1] == 0xd8);  // start of image
  const Picture back = decode_jpeg(file);
  REQUIRE(back.width == 640);
  REQUIRE(back.height == 480);
  const double error_80 = mean_error(picture, back);
  CHECK(error_80 < 3);
  const double error_95 = mean_error(picture, decode_jpeg(encoder.encode(picture, 95)));
  CHECK(error_95 < error_80);
  CHECK(mean_error(picture, decode_jpeg(encoder.encode(picture, 20))) > error_80);
}

TEST_CASE("A quality out of range, and a file that is no JPEG, are refused") {
  JpegEncoder encoder;
  const Picture grey{16, 16, std::vector<std::uint8_t>(3 * 16 * 16, 128)};
  CHECK_THROWS_AS(encoder.encode(grey, 0), std::invalid_argument);
  CHECK_THROWS_AS(encoder.encode(grey, 101), std::invalid_argument);
  const std::vector<std::uint8_t> noise(100, 7);
  CHECK_THROWS_AS(decode_jpeg(noise), std::runtime_error);
}
