// The program kenaf-canlog: what it prints of a log, and how it ends.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/support/process.hpp"

using namespace kenaf;

namespace {

struct Ended {
  int status;
  std::string text;
};

// kenaf-canlog on a file of these lines.
Ended run(const std::string& lines, std::vector<std::string> options = {}) {
  const support::TemporaryFolder folder;
  const std::string log = folder.path() / "bus.log", output = folder.path() / "output";
  std::ofstream(log) << lines;
  std::vector<std::string> argv{KENAF_CANLOG, log, "--robot",
                                std::string(KENAF_SOURCE_DIR) + "/share/robots/kenaf.toml"};
  argv.insert(argv.end(), options.begin(), options.end());
  support::Process program(argv, output);
  const int status = program.wait().value();
  std::ifstream file(output);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  for (std::size_t at; (at = text.find(log)) != std::string::npos;) text.replace(at, log.size(), "LOG");
  return {status, text};
}

const std::string kLog =
    "# a comment\n"
    "(1.000000) can0 701#00\n"
    "(1.000500) can0 000#0101\n"
    "(1.010000) can0 080#\n";

}  // namespace

TEST_CASE("kenaf-canlog prints each frame in words, with its time since the first") {
  const Ended ended = run(kLog);
  CHECK(ended.status == 0);
  CHECK(ended.text ==
        "    0.000000  track left: boot-up\n"
        "    0.000500  NMT start: track left\n"
        "    0.010000  SYNC\n");
}

TEST_CASE("kenaf-canlog --check names what is broken, and ends with 1 where something is") {
  CHECK(run(kLog, {"--check"}).status == 0);
  const Ended ended = run(kLog + "(1.011000) can0 080#0102\n", {"--check"});
  CHECK(ended.status == 1);
  CHECK(
      ended.text ==
      "LOG:5: 0.011000 s: length: SYNC has 2 bytes, not 0 to 1\n"
      "rule length (CiA 301, 7.2): each service has its length: NMT 2, SYNC 0 or 1, heartbeat 1, SDO, EMCY and LSS 8, "
      "PDOs as they are mapped\n"
      "4 frames, 19 rules, violations: 1\n");
}

TEST_CASE("kenaf-canlog prints 20 errors of a kind, and counts the others") {
  // 22 of SYNC's length and 23 lines that are none
  std::string lines = kLog;
  for (int i = 0; i < 22; ++i) lines += "(1.02) can0 080#0102\n";
  for (int i = 0; i < 23; ++i) lines += "nonsense\n";
  const auto count = [](const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  const std::string few = run(lines, {"--check"}).text, all = run(lines, {"--check", "--all"}).text;
  CHECK(count(few, "SYNC has 2 bytes") == 20);
  CHECK(count(few, "\"nonsense\" is not") == 20);
  CHECK_THAT(few, Catch::Contains("LOG: length: 2 more violations") &&
                      Catch::Contains("LOG: 3 more lines that cannot be read") && Catch::Contains("violations: 22"));
  CHECK(count(all, "SYNC has 2 bytes") == 22);
  CHECK(count(all, "\"nonsense\" is not") == 23);
  CHECK(count(all, " more ") == 0);
}

TEST_CASE("kenaf-canlog names a step of the clock, intervals, missing times and a format that it does not read") {
  CHECK_THAT(run("(10.0) can0 080#\n(3.5) can0 080#\n").text,
             Catch::Contains("LOG:2: the recorder's clock steps back by 6.500000 s"));
  CHECK_THAT(run("(000.000000) can0 080#\n(000.010000) can0 080#\n(000.010000) can0 080#\n").text,
             Catch::Contains("intervals (`candump -td`)") && Catch::Contains("    0.020000  SYNC"));
  const Ended no_times = run("  can0  080   [0]\n");
  CHECK_THAT(no_times.text, Catch::Contains("has no times") && Catch::Contains("\nSYNC\n"));
  const Ended binary = run("LOGG\x90");
  CHECK(binary.status == 2);
  CHECK_THAT(binary.text,
             Catch::Contains("LOG") && Catch::Contains("a binary log of Vector (.blf), which is not read"));
}

TEST_CASE("kenaf-canlog passes over bad lines by name, and over another bus") {
  const Ended ended = run("nonsense\n" + kLog + "(1.02) can1 080#\n");
  CHECK(ended.status == 0);
  CHECK_THAT(ended.text, Catch::Contains("LOG:1: \"nonsense\" is not a time") &&
                             Catch::Contains("1 lines are not from can0") && Catch::Contains("track left: boot-up"));
  CHECK_THAT(run(kLog, {"--figures"}).text, Catch::Contains("2 frames") && Catch::Contains("of 500 kbit/s"));
}

TEST_CASE("kenaf-canlog ends with 2 where its words cannot be written") {
  if (!std::filesystem::exists("/dev/full")) return;
  const support::TemporaryFolder folder;
  const std::string log = folder.path() / "bus.log";
  std::ofstream(log) << kLog;
  support::Process program({KENAF_CANLOG, log, "--robot", std::string(KENAF_SOURCE_DIR) + "/share/robots/kenaf.toml"},
                           "/dev/full");
  CHECK(program.wait() == 2);
}

TEST_CASE("kenaf-canlog ends with 2 where there is nothing to read") {
  CHECK(run("").status == 2);
  CHECK_THAT(run("nonsense\n").text, Catch::Contains("contains no frame"));
  CHECK(run(kLog, {"--interface", "can7"}).status == 2);
  CHECK(run(kLog, {"--robot", "nobody"}).status == 2);
  CHECK(run(kLog, {"--bitrate", "5"}).status == 2);
}
