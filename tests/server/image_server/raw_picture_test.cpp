#include "server/image_server/raw_picture.hpp"

#include <catch2/catch.hpp>

namespace kenaf::image_server {

namespace {

using Bytes8 = std::vector<std::uint8_t>;

// Pixel i, counted by rows, has red 10 i, green 10 i + 1, blue 10 i + 2.
camera::Picture counted(int width, int height) {
  camera::Picture picture{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    for (int colour = 0; colour < 3; ++colour) picture.rgb.push_back(static_cast<std::uint8_t>(10 * i + colour));
  }
  return picture;
}

}  // namespace

TEST_CASE("A raw picture is its size, then rows of blue, green, red, filled up to four bytes") {
  CHECK(raw_picture(counted(3, 2), 0, 0, 3, 2) ==
        Bytes8{0,  3,  0,  2,                                // u16 width, u16 height
               2,  1,  0,  12, 11, 10, 22, 21, 20, 0, 0, 0,  // 9 bytes and 3 to fill up
               32, 31, 30, 42, 41, 40, 52, 51, 50, 0, 0, 0});
  CHECK(raw_picture(counted(4, 1), 0, 0, 4, 1).size() == 4 + 12);
}

TEST_CASE("A part of it is what lies within the picture") {
  const camera::Picture picture = counted(3, 2);
  CHECK(raw_picture(picture, 1, 1, 1, 1) == Bytes8{0, 1, 0, 1, 42, 41, 40, 0});
  CHECK(raw_picture(picture, 2, 0, 0xffffffff, 0xffffffff) == Bytes8{0, 1, 0, 2, 22, 21, 20, 0, 52, 51, 50, 0});
  CHECK(raw_picture(picture, 3, 0, 1, 1).empty());
  CHECK(raw_picture(picture, 0, 2, 1, 1).empty());
  CHECK(raw_picture(picture, 0, 0, 0, 1).empty());
  CHECK(raw_picture(picture, 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff).empty());
}

}  // namespace kenaf::image_server
