// What the example programs say of arguments that they do not take. No server runs: a wrong argument is refused before
// anything is opened, and moved.
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/process.hpp"

namespace {

using namespace kenaf;

void check_is_refused(const std::string& program, const std::vector<std::string>& arguments, const std::string& words) {
  const support::TemporaryFolder folder;
  std::vector<std::string> argv{KENAF_BIN_DIR "/" + program};
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  support::Process process(argv, folder.path() / "log");
  const auto status = process.wait();
  std::ifstream file(folder.path() / "log");
  const std::string said{std::istreambuf_iterator<char>(file), {}};
  INFO(program << " " << (arguments.empty() ? "" : arguments.back()) << ": " << said);
  CHECK(status == 2);
  CHECK_THAT(said, Catch::Contains(words));
}

}  // namespace

TEST_CASE("An example program refuses arguments that it does not take, and opens no robot") {
  for (const std::string name : {"square", "flipper_exercise", "obstacle_drive"})
    for (const std::string argument : {"--help", "200", ""})
      check_is_refused(name + "_sim", {argument}, name + ": not expected: " + argument);
  for (const std::string count : {"", "0", "-1", "ten", "10s", "1.5", "1000001", "99999999999999999999", "--help"}) {
    check_is_refused("status_monitor_sim", {count}, "usage: status_monitor [COUNT]");
    check_is_refused("save_picture_sim", {"Camera", count}, "usage: save_picture [CAMERA [COUNT]]");
  }
  check_is_refused("status_monitor_sim", {"1", "2"}, "usage: status_monitor");
  check_is_refused("save_picture_sim", {"Camera", "1", "2"}, "usage: save_picture");
  check_is_refused("save_picture_sim", {"--help"}, "usage: save_picture");
}
