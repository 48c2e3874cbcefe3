// The program kenaf-describe: files, what it says of them, and its exit status.
#include <catch2/catch.hpp>

#include "physics/robot_description.hpp"
#include "tests/support/outcome.hpp"
#include "tests/tools/describe/small_urdf.hpp"

using namespace kenaf;
using test::read_file;
using test::TemporaryFolder;
using test::write_file;

namespace {

test::Outcome kenaf_describe(const TemporaryFolder& folder, const std::string& arguments) {
  return test::outcome_in(folder, "'" KENAF_DESCRIBE "' " + arguments);
}

}  // namespace

TEST_CASE("A URDF becomes a file that loads, and what was chosen is listed") {
  const TemporaryFolder folder;
  write_file(folder / "small.urdf", test::kSmallUrdf);
  const test::Outcome answer = kenaf_describe(
      folder,
      "from-urdf small.urdf --out small.toml --set drive.time_constant_s=0.2 --set battery.open_circuit_v=24.0");
  CHECK(answer.status == 0);
  CHECK(answer.out.empty());
  CHECK_THAT(answer.error, Catch::Contains("not in the URDF, so chosen; --set KEY=VALUE gives another value:\n") &&
                               Catch::Contains("  drive.idle_amperes = 0.3\n") && !Catch::Contains("time_constant_s"));
  const physics::RobotDescription robot = physics::load_robot((folder / "small.toml").string());
  CHECK(robot.drive.time_constant_s == 0.2);
  CHECK(robot.battery.open_circuit_v == 24);
}

TEST_CASE("Without --out, standard output has the file and nothing else") {
  const TemporaryFolder folder;
  write_file(folder / "small.urdf", test::kSmallUrdf);
  const test::Outcome made = kenaf_describe(folder, "from-urdf small.urdf --class USARBot.Mine");
  CHECK(made.status == 0);
  CHECK(physics::parse_robot(made.out, "out").usarsim_class == "USARBot.Mine");
  const test::Outcome urdf = kenaf_describe(folder, "to-urdf kenaf");
  CHECK(urdf.status == 0);
  CHECK_THAT(urdf.out, Catch::StartsWith("<?xml") && Catch::EndsWith("</robot>\n"));
  CHECK_THAT(urdf.error, Catch::Contains("not in the URDF:") && Catch::Contains("tracks are fixed"));
}

TEST_CASE("A mesh beside the URDF, in a folder that is not the current one") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "robot");
  write_file(folder / "robot/hull.obj",
             "v 0 0 0\nv 0.4 0 0\nv 0 0.2 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  write_file(folder / "robot/small.urdf",
             test::replaced(test::kSmallUrdf, "<box size=\"0.4 0.3 0.1\"/>", "<mesh filename=\"hull.obj\"/>"));
  const test::Outcome answer = kenaf_describe(folder, "from-urdf robot/small.urdf");
  CHECK(answer.status == 0);
  CHECK(physics::parse_robot(answer.out, "out").body.size_m.x() == Approx(0.4));
}

TEST_CASE("Wrong input to kenaf-describe: exit status 2, what is wrong, and no file") {
  const TemporaryFolder folder;
  write_file(folder / "small.urdf", test::kSmallUrdf);
  write_file(folder / "broken.urdf", test::replaced(test::kSmallUrdf, "mass value=\"0.5\"", "mass value=\"-1\""));
  struct Case {
    std::string arguments, words;
  };
  for (const Case& c : {Case{"from-urdf none.urdf --out a", "none.urdf"},
                        {"from-urdf broken.urdf --out a", "broken.urdf: link \"left_wheel\" has a mass of -1 kg"},
                        {"from-urdf small.urdf --out a --set drive.speed=1", "no \"drive.speed\""},
                        {"from-urdf small.urdf --out a --set drive.max_force_n=-1", "would not load"},
                        {"from-urdf small.urdf --out a --package small", "--package small: must be NAME=FOLDER"},
                        {"from-urdf small.urdf --out a --tolerance -1", "--tolerance"},
                        {"from-urdf small.urdf --out no/such/folder/a", "no/such/folder/a"},
                        {"to-urdf no-such-robot --out a", "no-such-robot"},
                        {"to-urdf", "robot is required"},
                        {"both", "subcommand is required"},
                        {"", "subcommand is required"}}) {
    INFO(c.arguments);
    const test::Outcome answer = kenaf_describe(folder, c.arguments);
    CHECK(answer.status == 2);
    CHECK_THAT(answer.error, Catch::Contains(c.words));
    CHECK_FALSE(std::filesystem::exists(folder / "a"));
  }
}
