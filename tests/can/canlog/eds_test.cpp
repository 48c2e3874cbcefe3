// kenaf-canlog eds: a data sheet of all that the library needs of a track's drive fits; each change of it is named.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <map>

#include "can/canbus/bus_layout.hpp"
#include "can/canbus/node_setup.hpp"
#include "can/canlog/eds_check.hpp"
#include "tests/support/process.hpp"

using namespace kenaf;

namespace {

const canbus::RobotBus& kenaf_bus() {
  static const canbus::RobotBus bus = canbus::load_robot_bus("kenaf");
  return bus;
}

std::string section_of(const canopen::MappedObject& object) {
  // CiA 301, 7.4.7: the numbers of the data types, in the order of canopen::ObjectType
  constexpr int kTypes[] = {5, 6, 7, 2, 3, 4};
  return fmt::format("[{:x}sub{:x}]\nDataType={}\nAccessType=rw\nPDOMapping=1\n", object.object.index,
                     object.object.sub, kTypes[static_cast<std::size_t>(object.type)]);
}

constexpr canopen::MappedObject kHeartbeatWatch{{0x1016, 1}, canopen::ObjectType::unsigned32},
    kEventTimer{{0x1400, 5}, canopen::ObjectType::unsigned16};

// A data sheet that has exactly what the left track's drive needs, and one of the two watches.
std::string fitting_eds(const canopen::MappedObject& watch = kHeartbeatWatch) {
  std::map<canopen::ObjectAddress, canopen::MappedObject> objects{{watch.object, watch}};
  for (const canbus::SdoStep& step : all_steps_of_drive(kenaf_bus(), 0, 0.01)) {
    if (!step.optional) objects[step.what.object] = {step.what.object, step.what.type};
  }
  const canbus::DrivePdos pdos = pdos_of(kenaf_bus(), 0);
  for (const canopen::Pdo* pdo : {&pdos.state, &pdos.effort, &pdos.battery, &pdos.command})
    for (const canopen::MappedObject& mapped : pdo->objects) objects[mapped.object] = mapped;
  std::string text;
  for (const auto& [address, object] : objects) text += section_of(object);
  return text;
}

std::vector<std::string> found_in(const std::string& eds, const canbus::RobotBus& bus = kenaf_bus()) {
  std::vector<std::string> words;
  for (const canlog::EdsFinding& one : canlog::check_eds(canopen::read_eds(eds), bus, 0, 0.01))
    words.push_back(to_string(one.object) + " " + one.words);
  return words;
}

// The fitting one with a text of it replaced.
std::vector<std::string> found_after(const std::string& section, const std::string& from, const std::string& to) {
  std::string eds = fitting_eds();
  const std::size_t at = eds.find(from, eds.find(section));
  REQUIRE(at != std::string::npos);
  return found_in(eds.replace(at, from.size(), to));
}

}  // namespace

TEST_CASE("A data sheet with all objects of the set-up fits the drive") {
  CHECK(found_in(fitting_eds()).empty());
}

TEST_CASE("What does not fit is named with object and purpose, once") {
  using Catch::Contains;
  const auto only = [](const std::vector<std::string>& found) {
    REQUIRE(found.size() == 1);
    return found[0];
  };
  CHECK_THAT(only(found_after("[6060sub0]", "=rw", "=ro")),
             Contains("0x6060:00 is read only, but is written (mode of operation)"));
  CHECK_THAT(only(found_after("[6085sub0]", "[6085sub0]", "[2085sub0]")),
             Contains("0x6085:00 is not in the file, but is written (quick stop deceleration)"));
  CHECK_THAT(only(found_after("[606csub0]", "PDOMapping=1", "PDOMapping=0")),
             Contains("0x606c:00 has PDOMapping=0, but belongs in TPDO2"));
  CHECK_THAT(only(found_after("[6502sub0]", "=rw", "=wo")), Contains("0x6502:00 is write only, but is read"));
  CHECK_THAT(only(found_after("[605asub0]", "=rw\n", "=rw\nHighLimit=5\n")),
             Contains("0x605a:00 is at most 5, but 6 is written (hold after a quick stop)"));
  CHECK_THAT(only(found_after("[6083sub0]", "DataType=7", "DataType=6")),
             Contains("0x6083:00 is UNSIGNED16, but has 32"));
}

TEST_CASE("A drive without any watch for its master is found, as the library refuses it") {
  using Catch::Contains;
  CHECK(found_in(fitting_eds(kEventTimer)).empty());

  // neither: the object of the watch is none that the library reads or writes
  const std::vector<std::string> neither = found_in(fitting_eds(canopen::object::supported_modes));
  REQUIRE(neither.size() == 1);
  CHECK_THAT(neither[0], Contains("0x1016:01 cannot be written, nor is a watch of commands possible (0x1400:05)") &&
                             Contains("nothing would stop the drive") &&
                             Contains("`error_control = \"node guarding\"` in a device file"));

  // the description's own words count
  canbus::RobotBus bus = kenaf_bus();
  bus.event_timer = false;
  const std::vector<std::string> unwatched = found_in(fitting_eds(kEventTimer), bus);
  REQUIRE(unwatched.size() == 1);
  CHECK_THAT(unwatched[0], Contains("(0x1400:05, `event_timer = false` in [can])"));
  CHECK(found_in(fitting_eds(kHeartbeatWatch), bus).empty());
  bus.event_timer = true;
  const std::vector<std::string> required = found_in(fitting_eds(kHeartbeatWatch), bus);
  REQUIRE(required.size() == 1);
  CHECK_THAT(required[0], Contains("0x1400:05 is no event timer that can be written"));
  CHECK(found_in(fitting_eds(kEventTimer), bus).empty());

  // one that is there but cannot be written is a refusal of the drive's, not a lack, also beside the other watch
  const std::vector<std::string> read_only = found_after("[1016sub1]", "=rw", "=ro");
  REQUIRE(read_only.size() == 2);
  CHECK_THAT(read_only[0], Contains("0x1016:01 is read only, but is written"));
  CHECK_THAT(read_only[1], Contains("0x1016:01 cannot be written, nor is"));
}

TEST_CASE("A drive with node guarding has its watch by objects that must be there") {
  canbus::RobotBus bus = kenaf_bus();
  bus.drives[0].device.error_control = canbus::ErrorControl::node_guarding;
  bus.event_timer = false;
  const std::vector<std::string> found = found_in(fitting_eds(), bus);
  REQUIRE(found.size() == 2);
  CHECK_THAT(found[0], Catch::Contains("0x100c:00 is not in the file, but is written"));
  CHECK_THAT(found[1], Catch::Contains("0x100d:00 is not in the file, but is written"));
}

TEST_CASE("kenaf-canlog eds prints the objects, and ends with 1 where one does not fit, with 2 where nothing is read") {
  const support::TemporaryFolder folder;
  const std::string path = folder.path() / "drive.eds", output = folder.path() / "output";
  const auto run = [&](const std::string& eds, std::vector<std::string> options) {
    std::ofstream(path) << eds;
    std::vector<std::string> argv{KENAF_CANLOG, "eds", path};
    argv.insert(argv.end(), options.begin(), options.end());
    support::Process program(argv, output);
    const int status = program.wait().value();
    std::ifstream file(output);
    return std::pair(status, std::string{std::istreambuf_iterator<char>(file), {}});
  };
  const std::string robot = std::string(KENAF_SOURCE_DIR) + "/share/robots/kenaf.toml";
  const auto [alone, listed] = run(fitting_eds(), {});
  CHECK(alone == 0);
  CHECK_THAT(listed, Catch::Contains("0x6040:00  UNSIGNED16      read and write  PDO"));
  CHECK(run(fitting_eds(), {"--robot", robot, "--node", "1"}).first == 0);
  const auto [flipper, says] = run(fitting_eds(), {"--robot", robot, "--node", "3"});
  CHECK(flipper == 1);
  CHECK_THAT(says, Catch::Contains("0x607d:01 is not in the file") && Catch::Contains("flipper front left (node 3)"));
  CHECK(run("nonsense", {}).first == 2);
  CHECK(run(fitting_eds() + "nonsense\n", {}).first == 1);
  CHECK(run(fitting_eds(), {"--robot", robot, "--node", "99"}).first == 2);
}
