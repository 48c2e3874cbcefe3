// Which commands a lossy link loses follows from the seed and the steps of the world, not from how often the server is
// woken while the world stands still.
#include "formats/description/description_file.hpp"
#include "server/world_server/manual_drive.hpp"
#include "tests/formats/runs/temporary_folder.hpp"
#include "tests/server/world_server/conversation.hpp"

namespace kenaf::world_server {

namespace {

struct LossyLink {
  test::TemporaryFolder folder;
  ServerOptions options = fast();

  LossyLink() {
    const std::string nominal = description::read_description_file("robot", "kenaf", ".toml").text;
    test::write_file(folder / "lossy.toml", nominal + "\n[effects.command_loss]\nprobability = 0.5\n");
    options.robot = (folder / "lossy.toml").string();
  }
};

constexpr const char* kPlace = "INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n";

// The world is paused and woken so often before it goes on.
void wake_in_a_pause(Conversation& talk, int times) {
  talk.send("CONTROL {Type Pause}\r\n");
  for (int i = 0; i < times; ++i) CHECK_FALSE(talk.simulation.advance(talk.wall_s).stepped);
  talk.send("CONTROL {Type Resume}\r\n");
}

}  // namespace

TEST_CASE("A client's silence on a lossy link: being woken in a pause changes no bit of the run") {
  const LossyLink link;
  const auto path = [&](int times) {
    Conversation talk(link.options);
    talk.send(std::string(kPlace) + "CONTROL {Type Session} {Period 0.01} {CommandTimeout 0.05}\r\n");
    for (int i = 0; i < 20; ++i) {
      talk.send("DRIVE {Left " + std::to_string(i % 5) + "} {Right 4}\r\n");
      REQUIRE(talk.run(0.1));
      REQUIRE(talk.session->silent);
      wake_in_a_pause(talk, times);
    }
    return talk.truth();
  };
  const physics::RobotTruth once = path(1), often = path(3);
  CHECK(once.X_WB.p == often.X_WB.p);
  CHECK(once.X_WB.q.coeffs() == often.X_WB.q.coeffs());
  CHECK(once.X_WB.p.head<2>().norm() > 0.05);  // not all were lost
}

TEST_CASE("An operator's silence on a lossy link: being woken in a pause changes no bit of the run") {
  const LossyLink link;
  const auto path = [&](int times) {
    Conversation talk(link.options);
    talk.send(kPlace);
    talk.simulation.wall_s = talk.wall_s;
    REQUIRE(take_robot(talk.simulation, talk.session->id, OperatorId{1}).empty());
    robot::Command command = standing_command();
    for (int i = 0; i < 20; ++i) {
      command.track_speed_mps = {0.1 * (i % 5), 0.4};
      talk.simulation.wall_s = talk.wall_s;
      REQUIRE(drive_by_hand(talk.simulation, talk.session->id, OperatorId{1}, command).empty());
      REQUIRE(talk.run(0.05));
      talk.wall_s += 1;
      REQUIRE(talk.run(0.05));
      REQUIRE(talk.session->hold->silent);
      wake_in_a_pause(talk, times);
    }
    return talk.truth();
  };
  const physics::RobotTruth once = path(1), often = path(3);
  CHECK(once.X_WB.p == often.X_WB.p);
  CHECK(once.X_WB.q.coeffs() == often.X_WB.q.coeffs());
  CHECK(once.X_WB.p.head<2>().norm() > 0.05);
}

TEST_CASE("A client's silence is told to a lossy link until it arrives") {
  const LossyLink link;
  for (int i = 0; i < 5; ++i) {
    ServerOptions options = link.options;
    options.seed = static_cast<std::uint64_t>(i);
    Conversation talk(options);
    talk.send(std::string(kPlace) + "CONTROL {Type Session} {Period 0.01} {CommandTimeout 0.05}\r\n");
    for (int j = 0; j < 10; ++j) talk.send("DRIVE {Left 4} {Right 4}\r\n");
    REQUIRE(talk.run(0.5));  // 450 steps of silence: that all were lost has a probability of 2^-450
    CHECK(std::abs(talk.truth().v_WB_mps.x()) < 0.02);
  }
}

}  // namespace kenaf::world_server
