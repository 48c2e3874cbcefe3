// These tests speak USARSim's image protocol and its extensions through real sockets. They compare raw pictures, JPEGs
// and parts with the renderer's own output, and edges in them with geometry. They check pacing, the choice of views,
// answers in words, and that hostile or slow readers disturb nobody else.
#include "server/image_server/image_server.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <future>

#include "camera/jpeg.hpp"
#include "camera/renderer.hpp"
#include "camera/robot_cameras.hpp"
#include "server/world_server/simulation.hpp"
#include "tests/server/image_server/image_client.hpp"
#include "tests/server/image_server/served_cameras.hpp"
#include "tests/support/patience.hpp"

namespace kenaf::image_server {

namespace {

using Image = ImageClient::Image;

// As the robots stand now.
camera::WorldSnapshot snapshot_of(CameraWorld& world) {
  std::promise<camera::WorldSnapshot> promise;
  world.server.ask([&](world_server::Simulation& simulation) {
    camera::WorldSnapshot snapshot;
    camera::SnapshotTaker().take(simulation.world, snapshot);
    promise.set_value(std::move(snapshot));
  });
  return promise.get_future().get();
}

camera::View view_of(const camera::WorldSnapshot& snapshot, const std::string& camera,
                     double field_of_view_rad = 1.05) {
  const camera::RobotSnapshot& robot = snapshot.robots.front();
  return camera::camera_view(robot, *camera::find_camera(*robot.description, camera), field_of_view_rad);
}

camera::Picture drawn(CameraWorld& world, const camera::WorldSnapshot& snapshot, const camera::View& view) {
  camera::Scene scene(world.server.world_description());
  scene.update(snapshot);
  camera::Picture picture;
  camera::Renderer().render(scene, view, picture);
  return picture;
}

// Of a raw answer.
camera::Picture picture_of(const Image& image) {
  REQUIRE(image.type == 0);
  REQUIRE(image.bytes.size() >= 4);
  camera::Picture out;
  out.width = image.bytes[0] << 8 | image.bytes[1];
  out.height = image.bytes[2] << 8 | image.bytes[3];
  const std::size_t pitch = static_cast<std::size_t>(out.width * 3 + 3) / 4 * 4;
  REQUIRE(image.bytes.size() == 4 + pitch * static_cast<std::size_t>(out.height));
  for (std::size_t row = 0; row < static_cast<std::size_t>(out.height); ++row) {
    for (std::size_t column = 0; column < static_cast<std::size_t>(out.width); ++column) {
      const std::uint8_t* bgr = &image.bytes[4 + pitch * row + 3 * column];
      out.rgb.insert(out.rgb.end(), {bgr[2], bgr[1], bgr[0]});
    }
  }
  return out;
}

double mean_difference(const camera::Picture& a, const camera::Picture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(a.rgb[i] - b.rgb[i]);
  return sum / static_cast<double>(a.rgb.size());
}

Stamp stamp(const Image& image) {
  const auto found = stamp_of(image.bytes);
  REQUIRE(found);
  return *found;
}

double brightness(const camera::Picture& picture, int column, int row) {
  const std::uint8_t* rgb = picture.at(column, row);
  return (rgb[0] + rgb[1] + rgb[2]) / 3.0;
}

// As in tests/camera/picture_test.cpp: the first row from above that is as dark as the box's front face below its edge.
// Looks down to `last_row`, as the robot's own flippers may be darker.
int upper_edge_row(const camera::Picture& picture, int column, int last_row) {
  double darkest = 255;
  for (int row = 0; row <= last_row; ++row) darkest = std::min(darkest, brightness(picture, column, row));
  int row = 0;
  while (brightness(picture, column, row) > 1.15 * darkest) ++row;
  return row;
}

std::size_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  std::size_t total = 0, resident = 0;
  file >> total >> resident;
  return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

}  // namespace

TEST_CASE("OK, split or not, is answered by the picture that the renderer draws") {
  CameraWorld world("step-200", 1, ImageType::raw);
  Robot robot(world, "R1");
  robot.ask("CONTROL {Type Pause}");
  ImageClient client(world.port());
  const camera::WorldSnapshot snapshot = snapshot_of(world);
  const camera::Picture expected = drawn(world, snapshot, view_of(snapshot, "Camera"));
  Image image = client.ask("OK\r\n");
  CHECK(picture_of(image).rgb == expected.rgb);
  CHECK(image.bytes.size() == 4 + 640 * 3 * 480);
  client.send("O");
  CHECK_FALSE(client.hears(50));
  image = client.ask("K");
  CHECK(picture_of(image).rgb == expected.rgb);
}

TEST_CASE("A JPEG has the type that was chosen, and its quality") {
  CameraWorld world("step-200", 1, ImageType::good);
  Robot robot(world, "R1");
  robot.ask("CONTROL {Type Pause}");
  const camera::WorldSnapshot snapshot = snapshot_of(world);
  const camera::Picture expected = drawn(world, snapshot, view_of(snapshot, "Camera"));
  std::size_t good_bytes = 0, bytes_before = 1 << 30;
  double difference_before = 0;
  for (const ImageType type :
       {ImageType::superb, ImageType::good, ImageType::normal, ImageType::fair, ImageType::bad}) {
    ImageServer server(world.feed, "127.0.0.1", 0, type);
    ImageClient client(server.port());
    const Image image = client.ask();
    CHECK(image.type == static_cast<int>(type));
    const camera::Picture picture = camera::decode_jpeg(image.bytes);
    const double difference = mean_difference(picture, expected);
    INFO("type " << image.type << ": " << image.bytes.size() << " bytes, mean difference " << difference);
    CHECK(image.bytes.size() < bytes_before);
    CHECK(difference > difference_before);
    CHECK(difference < 10);
    bytes_before = image.bytes.size();
    difference_before = difference;
    if (type == ImageType::good) good_bytes = image.bytes.size();
    // J is a JPEG of the camera's own quality whatever the type
    const Image own = client.ask("J");
    CHECK(own.type == 2);
    if (good_bytes > 0) CHECK(own.bytes.size() == Approx(good_bytes).margin(8));  // ages have more digits or less
    if (type == ImageType::good) CHECK(difference < 3);
  }
  ImageServer raw(world.feed, "127.0.0.1", 0, ImageType::raw);
  ImageClient client(raw.port());
  CHECK(client.ask("J").type == 2);
  CHECK(client.ask("OK").type == 0);
}

TEST_CASE("Parts are of the raw picture, cut at its border, and nonsense is answered in words") {
  CameraWorld world("step-200");
  Robot robot(world, "R1");
  robot.ask("CONTROL {Type Pause}");
  ImageClient client(world.port());
  const camera::WorldSnapshot snapshot = snapshot_of(world);
  const camera::Picture whole = drawn(world, snapshot, view_of(snapshot, "Camera"));
  const camera::Picture part = picture_of(client.ask(part_request(600, 300, 100, 3)));
  REQUIRE(part.width == 40);
  REQUIRE(part.height == 3);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 40; ++column) {
      for (int colour = 0; colour < 3; ++colour) {
        REQUIRE(part.at(column, row)[colour] == whole.at(600 + column, 300 + row)[colour]);
      }
    }
  }
  for (const std::string& nonsense :
       {part_request(640, 0, 1, 1), part_request(0, 0, 0, 5), part_request(0xffffffff, 0xffffffff, 0xffffffff, 1)}) {
    CHECK(client.ask(nonsense).type == 255);
  }
  CHECK(client.ask("OK").type == 2);
}

TEST_CASE("Each OK brings a newer frame, which says its number, its robot time and its age") {
  CameraWorld world;
  Robot robot(world, "R1");
  ImageClient client(world.port());
  client.ask();
  Stamp last = stamp(client.ask());
  CHECK(last.robot == "R1");
  CHECK(last.camera == "Camera");
  for (int i = 0; i < 10; ++i) {
    const Stamp next = stamp(client.ask());
    REQUIRE(next.number > last.number);
    const double expected_s = static_cast<double>(next.number - last.number) / 30;
    CHECK(next.robot_time_s - last.robot_time_s == Approx(expected_s).margin(0.00101));
    CHECK(next.age_ms >= 20);  // the camera's latency
    last = next;
  }
}

TEST_CASE("Without a new frame the old one comes again, within a second and so much older") {
  CameraWorld world;
  Robot robot(world, "R1");
  robot.ask("CONTROL {Type Pause}");
  ImageClient client(world.port());
  const Stamp first = stamp(client.ask());
  const auto asked = std::chrono::steady_clock::now();
  const Stamp second = stamp(client.ask());
  CHECK(std::chrono::steady_clock::now() - asked >= std::chrono::milliseconds(890));
  CHECK(second.number == first.number);
  CHECK(second.age_ms >= first.age_ms + 890);
}

TEST_CASE("Requests that pile up are one, and a silent reader has nothing drawn") {
  CameraWorld world;
  Robot robot(world, "R1");
  ImageClient silent(world.port());
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  CHECK(world.feed.newest().empty());
  robot.ask("CONTROL {Type Pause}");
  ImageClient client(world.port());
  client.ask();
  client.send("OKOKOKOKOK");
  client.read();
  CHECK_FALSE(client.hears(1500));  // the four others would have been answered a second after it
}

TEST_CASE("V chooses what is shown, also with two robots, and words say what there is") {
  CameraWorld world;
  ImageClient client(world.port());
  Image image = client.ask("J");
  CHECK(image.type == 255);
  CHECK(image.words() == "there is no robot in the world, hence no camera");
  Robot first(world, "R1");
  auto second = std::make_unique<Robot>(world, "R2", "0,3,0");
  const auto shown = [&](const std::string& view) {
    const Stamp found = stamp(client.ask(view_request(view) + "OK"));
    return found.robot + "/" + found.camera;
  };
  REQUIRE(support::eventually([&] { return client.ask().type == 2; }));
  CHECK(shown("") == "R2/Camera");
  CHECK(shown("BirdsEye") == "R2/BirdsEye");
  CHECK(shown("R1/Camera") == "R1/Camera");
  CHECK(shown("r1/birdseye") == "R1/BirdsEye");
  image = client.ask(view_request("R3/Camera") + "J");
  CHECK(image.type == 255);
  CHECK(image.words().find("R1/BirdsEye, R2/Camera") != std::string::npos);
  CHECK(image.words().find("R3/Camera") != std::string::npos);
  image = client.ask(view_request(std::string(255, '\xff')) + "OK");
  CHECK(image.type == 255);
  CHECK(shown("R2/Camera") == "R2/Camera");
  second.reset();
  CHECK(support::eventually([&] { return client.ask().type == 255; }));
  CHECK(shown("") == "R1/Camera");
}

TEST_CASE("An OK of a client that knows no words waits for the first picture, however long") {
  ImageServerLimits limits;
  limits.first_s = 0.1;
  const bool chooses_a_part_first = GENERATE(false, true);  // U is as old as OK
  CameraWorld world("flat", 1, ImageType::good, limits);
  ImageClient client(world.port());
  if (chooses_a_part_first) client.send(part_request(0, 0, 1, 1));
  client.send("OK");
  CHECK_FALSE(client.hears(500));
  Robot robot(world, "R1");
  CHECK(client.read().type == 2);
}

TEST_CASE("Robots may leave in mid-frame") {
  CameraWorld world("flat", 0, ImageType::raw);
  ImageClient slow(world.port(), 4096), quick(world.port());
  for (int round = 0; round < 5; ++round) {
    auto robot = std::make_unique<Robot>(world, "R1");
    REQUIRE(support::eventually([&] { return quick.ask("J").type == 2; }));
    slow.send("OK");
    REQUIRE(slow.hears(20000));
    quick.send("J");
    robot.reset();
    quick.read();
    const Image image = slow.read();
    CHECK((image.type == 255 || image.bytes.size() == 4 + 640 * 3 * 480));
  }
}

TEST_CASE("Garbage is skipped, and nobody else is disturbed") {
  CameraWorld world;
  Robot robot(world, "R1");
  ImageClient client(world.port());
  std::uint32_t state = 1;
  for (int round = 0; round < 20; ++round) {
    ImageClient hostile(world.port());
    std::string bytes;
    for (int i = 0; i < 20000; ++i) bytes += static_cast<char>((state = state * 1664525 + 1013904223) >> 24);
    hostile.send(bytes);
    CHECK(client.ask().type == 2);
  }
}

TEST_CASE("So many readers are served and no more") {
  ImageServerLimits limits;
  limits.connections = 3;
  CameraWorld world("flat", 1, ImageType::good, limits);
  Robot robot(world, "R1");
  ImageClient a(world.port()), b(world.port());
  CHECK(a.ask().type == 2);
  CHECK(b.ask().type == 2);
  {
    ImageClient c(world.port());
    CHECK(c.ask().type == 2);
    ImageClient d(world.port());
    CHECK(d.is_let_go());
  }
  // once one has gone there is room
  CHECK(support::eventually([&] {
    try {
      ImageClient e(world.port());
      return e.ask().type == 2;
    } catch (const std::runtime_error&) {
      return false;
    }
  }));
}

TEST_CASE("Fifty readers that do not read take a frame each at most, and are let go") {
  ImageServerLimits limits;
  limits.unread_s = 3;
  limits.connections = 51;
  CameraWorld world("flat", 1, ImageType::raw, limits);
  Robot robot(world, "R1");
  ImageClient client(world.port());
  CHECK(client.ask().type == 0);
  const std::size_t before = resident_bytes();
  std::vector<std::unique_ptr<ImageClient>> slow;
  for (int i = 0; i < 50; ++i) slow.push_back(std::make_unique<ImageClient>(world.port(), 4096));
  for (int round = 0; round < 20; ++round) {  // a thousand pictures are asked for: 921 MB
    for (const auto& reader : slow) reader->send("OKOKOKOK");
    CHECK(client.ask().type == 0);
  }
  // 50 readers of one picture of 0.92 MB each, pictures that are shared, and room for whatever else
  CHECK(resident_bytes() < before + (200 << 20));
  // all fifty have made room for others
  std::vector<std::unique_ptr<ImageClient>> others;
  CHECK(support::eventually([&] {
    auto other = std::make_unique<ImageClient>(world.port());
    other->send("J");
    try {
      if (other->read().type == 2) others.push_back(std::move(other));
    } catch (const std::runtime_error&) {  // not yet
    }
    return others.size() == 50;
  }));
  CHECK(client.ask().type == 0);
}

TEST_CASE("The edge of a step is where geometry has it, turned by MISPKG and zoomed by SET") {
  CameraWorld world("step-200");
  Robot robot(world, "R1");
  // To the right and up, as USARSim has it: the robot stays at rest meanwhile.
  const double pan_rad = GENERATE(0.0, 0.12, -0.1), tilt_rad = GENERATE(0.0, 0.05), angle_rad = GENERATE(1.05, 0.8);
  robot.client.send("MISPKG {Name CameraPanTilt} {Link 1} {Value " + std::to_string(pan_rad) + "} {Link 2} {Value " +
                    std::to_string(tilt_rad) + "}\r\n");
  robot.ask("SET {Type Camera} {Name Camera} {Opcode Zoom} {Params " + std::to_string(angle_rad) + "}");
  robot.ask("CONTROL {Type Pause}");
  robot.ask("CONTROL {Type Step} {Time 0.3}");
  const camera::WorldSnapshot snapshot = snapshot_of(world);
  // z down: a turn to the right is positive. REP 103, z up: the same turn is negative.
  camera::View view = view_of(snapshot, "Camera", angle_rad);
  const physics::Pose X_WM = compose(snapshot.robots[0].X_WB, snapshot.robots[0].description->mission_packages[0].X_BM);
  view.X_WC = {X_WM.p, X_WM.q * physics::rotation_from({0, -tilt_rad, -pan_rad})};
  ImageClient client(world.port());
  const camera::Picture picture = camera::decode_jpeg(client.ask("J").bytes);
  for (const double y : {-0.12, -0.07, 0.03, 0.13}) {
    const camera::Pixel edge = camera::project(view, {1, y, 0.2}).value();
    REQUIRE(camera::in_picture(view.lens, edge));
    INFO("pan " << pan_rad << ", tilt " << tilt_rad << ", angle of view " << angle_rad << ", edge at y = " << y);
    const int last_row = std::min(479, static_cast<int>(edge.v) + 30);
    CHECK(upper_edge_row(picture, static_cast<int>(edge.u), last_row) == Approx(edge.v).margin(2));
  }
  if (pan_rad > 0) {
    // what was in the middle is left of it now
    CHECK(camera::project(view, {1, 0, 0.2}).value().u < 320);
  }
}

}  // namespace kenaf::image_server
