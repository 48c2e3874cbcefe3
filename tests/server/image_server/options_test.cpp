#include "server/image_server/options.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>

namespace kenaf::image_server {

TEST_CASE("Camera options are read from words, and wrong ones refused in words") {
  CameraOptions options;
  set_cameras(options, "off");
  CHECK_FALSE(options.on);
  set_cameras(options, "on");
  CHECK(options == CameraOptions{});
  set_camera_port(options, "off");
  CHECK_FALSE(options.image_server);
  set_camera_port(options, "0");
  CHECK(options.image_server);
  CHECK(options.image_port == 0);
  set_camera_port(options, "65535");
  CHECK(options.image_port == 65535);
  for (const auto& [name, number] :
       {std::pair{"raw", 0}, {"superb", 1}, {"good", 2}, {"normal", 3}, {"fair", 4}, {"bad", 5}}) {
    set_camera_image(options, name);
    CHECK(static_cast<int>(options.image_type) == number);
  }
  CHECK_THROWS_WITH(set_cameras(options, "no"), "must be on or off");
  for (const char* wrong : {"", "-1", "65536", "1x", "5003 "})
    CHECK_THROWS_AS(set_camera_port(options, wrong), std::runtime_error);
  CHECK_THROWS_WITH(set_camera_image(options, "best"), "must be raw, superb, good, normal, fair or bad");
  CHECK_THROWS_WITH(set_camera_image(options, "gold"),
                    "must be raw, superb, good, normal, fair or bad; did you mean good?");
}

TEST_CASE("Better types have higher quality, and good is the camera's own") {
  CHECK(jpeg_quality(ImageType::good, 63) == 63);
  CHECK(jpeg_quality(ImageType::superb, 63) > 80);
  CHECK(jpeg_quality(ImageType::normal, 63) > jpeg_quality(ImageType::fair, 63));
  CHECK(jpeg_quality(ImageType::fair, 63) > jpeg_quality(ImageType::bad, 63));
}

}  // namespace kenaf::image_server
