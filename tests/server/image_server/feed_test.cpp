// The feed draws only the views that somebody asks for, at the camera's rate in robot time, and each picture shows the
// moment that it states. Robots may come and go and the world may be reset under it, and the feed ends whenever it is
// told to.
#include "server/image_server/feed.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "tests/server/image_server/served_cameras.hpp"
#include "tests/support/patience.hpp"

namespace kenaf::image_server {

namespace {

using FramePtr = std::shared_ptr<const Frame>;

// The next frame of the view that is not `before`.
FramePtr next_frame(Feed& feed, const std::string& view, const FramePtr& before = nullptr) {
  FramePtr frame;
  const bool came = support::eventually([&] {
    frame = feed.look(view).frame;
    return frame && frame != before;
  });
  if (!came) throw std::runtime_error("no frame of '" + view + "': " + feed.look(view).none);
  return frame;
}

std::string words_for(Feed& feed, const std::string& view) {
  std::string words;
  support::eventually([&] {
    words = feed.look(view).none;
    return !words.empty();
  });
  return words;
}

// 1 / 30 s of robot time for each number, to the step of 1 ms at which it is exposed.
void check_on_time(const Frame& earlier, const Frame& later) {
  REQUIRE(later.number > earlier.number);
  const double expected_s = static_cast<double>(later.number - earlier.number) / 30;
  CHECK(later.robot_time_s - earlier.robot_time_s == Approx(expected_s).margin(0.00101));
}

}  // namespace

TEST_CASE("Frames are of whole thirtieths of robot time, counted, and published after the latency") {
  const double speed = GENERATE(1.0, 0.0, 3.0);
  CameraWorld world("flat", speed);
  Robot robot(world, "R1");
  FramePtr frame = next_frame(world.feed, "R1/Camera");  // not always number 1: this thread may have looked late
  CHECK(frame->robot == "R1");
  CHECK(frame->camera == "Camera");
  CHECK(frame->image->picture.width == 640);
  CHECK(frame->image->picture.height == 480);
  FramePtr last = next_frame(world.feed, "R1/Camera", frame);  // the first was taken when it was asked for
  for (int i = 0; i < 5; ++i) {
    frame = next_frame(world.feed, "R1/Camera", last);
    // 20 ms of robot time by the clock; none where it has no pace
    if (speed > 0) CHECK(age_s(*frame) >= 0.02 / speed);
    CHECK(std::abs(30 * frame->robot_time_s - std::floor(30 * frame->robot_time_s + 1e-9)) < 0.03 + 1e-9);
    check_on_time(*last, *frame);
    last = frame;
  }
}

TEST_CASE("Cameras of one rate show the same moment") {
  CameraWorld world;
  Robot robot(world, "R1");
  const auto both = [&] {
    const FramePtr front = world.feed.look("Camera").frame, top = world.feed.look("BirdsEye").frame;
    return front && top && front->number > 2 && front->robot_time_s == top->robot_time_s;
  };
  CHECK(support::eventually(both));
}

TEST_CASE("A robot that is there is never called missing, however new it is") {
  CameraWorld world("hills");  // long drawing: exposures from before the new robot are on their way
  Robot first(world, "R1");
  next_frame(world.feed, "R1/BirdsEye");
  std::vector<std::unique_ptr<Robot>> others;
  for (int i = 2; i <= 12; ++i) {
    const std::string name = "R" + std::to_string(i), view = name + "/Camera";
    others.push_back(std::make_unique<Robot>(world, name, std::to_string(-2 * i) + ",0,0"));
    CHECK(support::eventually([&] {
      world.feed.look("R1/BirdsEye");
      const Feed::Look seen = world.feed.look(view);
      CHECK(seen.none == "");
      return seen.frame != nullptr || !seen.none.empty();
    }));
  }
}

TEST_CASE("Nothing is drawn while nobody looks, nor 2 s after the last look") {
  CameraWorld world;
  Robot robot(world, "R1");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  CHECK(world.feed.newest().empty());
  const FramePtr frame = next_frame(world.feed, "");
  CHECK(world.feed.newest().size() == 1);
  CHECK(support::eventually([&] { return world.feed.newest().empty(); }));  // newest() is no look
  // whoever looks again sees no old picture, and no number a second time
  const FramePtr again = next_frame(world.feed, "");
  CHECK(again->number > frame->number);
  CHECK(again->robot_time_s > frame->robot_time_s + 1);
}

TEST_CASE("What has not moved is not drawn again, and whatever moves is") {
  CameraWorld world;
  Robot robot(world, "R1");
  FramePtr last = next_frame(world.feed, "R1/Camera");
  const auto next = [&] { return last = next_frame(world.feed, "R1/Camera", last); };
  // it falls onto its tracks, then stands
  CHECK(support::eventually([&] {
    const auto before = last->image;
    return next()->image == before;
  }));
  const std::uint64_t number = last->number;
  CHECK(next()->number > number);

  const std::string order =
      GENERATE("DRIVE {Left 1.5} {Right -1.5}", "DRIVE {Name FLFlipper} {Value 0.2}", "MULTIDRIVE {RRFlipper 0.2}",
               "SET {Type Camera} {Name Camera} {Opcode FOV} {Params 0.8}");
  const auto standing = last->image;
  robot.client.send(order + "\r\n");
  CHECK(support::eventually([&] { return next()->image != standing; }));
}

TEST_CASE("Listeners are notified of frames until they let go") {
  CameraWorld world;
  Robot robot(world, "R1");
  std::atomic<int> notified = 0;
  auto handle = world.feed.listen([&] { ++notified; });
  CHECK(support::eventually([&] {
    world.feed.look("");
    return notified > 3;
  }));
  handle.reset();
  const int then = notified;
  next_frame(world.feed, "", next_frame(world.feed, ""));
  CHECK(notified == then);
}

TEST_CASE("Where time stands still the first picture comes, and then stays") {
  CameraWorld world;
  Robot robot(world, "R1");
  robot.ask("CONTROL {Type Pause}");
  const FramePtr frame = next_frame(world.feed, "");
  CHECK(frame->number == 1);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  CHECK(world.feed.look("").frame == frame);
  robot.ask("CONTROL {Type Step} {Time 0.1}");  // three thirtieths
  const FramePtr stepped = next_frame(world.feed, "", frame);
  CHECK(stepped->number > frame->number);
  CHECK(stepped->robot_time_s <= frame->robot_time_s + 0.1001);
}

TEST_CASE("After a reset time begins anew, and numbers go on") {
  CameraWorld world;
  Robot robot(world, "R1");
  FramePtr frame = next_frame(world.feed, "");
  while (frame->robot_time_s < 0.2) frame = next_frame(world.feed, "", frame);
  robot.ask("CONTROL {Type Pause}");
  frame = world.feed.look("").frame;
  robot.ask("CONTROL {Type Reset}");
  FramePtr first;
  REQUIRE(support::eventually([&] {
    first = world.feed.look("").frame;
    return first && first->robot_time_s == 0;
  }));
  CHECK(first->number > frame->number);
}

TEST_CASE("Robots come and leave while they are watched") {
  CameraWorld world;
  CHECK(words_for(world.feed, "") == "there is no robot in the world, hence no camera");
  for (int round = 0; round < 3; ++round) {
    Robot first(world, "R1");
    next_frame(world.feed, "");
    {
      Robot second(world, "R2", "0,3,0");
      CHECK(support::eventually([&] {
        const FramePtr frame = world.feed.look("").frame;
        return frame && frame->robot == "R2";  // the one placed last
      }));
      CHECK(next_frame(world.feed, "R1/BirdsEye")->robot == "R1");
    }
    CHECK(support::eventually([&] {
      const FramePtr frame = world.feed.look("").frame;
      return frame && frame->robot == "R1";
    }));
    CHECK(words_for(world.feed, "R2/Camera").find("R1/Camera") != std::string::npos);
  }
  CHECK(support::eventually([&] { return !world.feed.look("").none.empty(); }));
}

TEST_CASE("Names of no camera, however many are asked for, shut nobody out") {
  CameraWorld world;
  Robot robot(world, "R1");
  for (std::size_t i = 0; i < 3 * Feed::kMostViews; ++i)
    CHECK_FALSE(world.feed.look(std::to_string(i)).none.starts_with("too many"));
  CHECK(world.feed.look("R1/Camera").none.empty());
}

TEST_CASE("More views than anybody needs are refused, and forgotten") {
  CameraWorld world;
  Robot robot(world, "R1");
  // all names of one camera: their case does not matter
  const auto name = [](std::size_t which) {
    std::string out = "R1/BIRDSEYE";
    for (std::size_t letter = 0; letter < 8; ++letter)
      if ((which >> letter & 1) != 0) out[3 + letter] = static_cast<char>(out[3 + letter] - 'A' + 'a');
    return out;
  };
  CHECK(support::eventually([&] {  // once it is known what the others show
    bool refused = world.feed.look("R1/Camera").none.starts_with("too many");
    for (std::size_t i = 0; i < Feed::kMostViews; ++i)
      refused = world.feed.look(name(i)).none.starts_with("too many") || refused;
    return refused;
  }));
  CHECK(support::eventually([&] { return world.feed.look("R1/Camera").frame != nullptr; }));  // 2 s later
}

TEST_CASE("A feed ends while the world is not run, and while it draws") {
  {
    world_server::WorldServer server(CameraWorld::options("flat", 1));
    Feed feed(server);
    for (int i = 0; i < 30; ++i) {
      CHECK_FALSE(feed.look("").frame);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  world_server::WorldServer server(CameraWorld::options("flat", 0));
  std::thread thread([&] { server.run(); });
  {
    support::UsarsimClient client(server.port());
    client.send("INIT {ClassName USARBot.Kenaf}\r\n");
    client.line_that_begins("STA");
    for (int i = 0; i < 5; ++i) {
      Feed feed(server);
      next_frame(feed, "");
      feed.look("BirdsEye");
    }
  }
  server.stop();
  thread.join();
}

}  // namespace kenaf::image_server
