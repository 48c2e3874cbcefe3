// A TCP stream becomes lines, however it was cut into packets and whichever line ends its sender uses.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "formats/protocol/usarsim_message.hpp"

using namespace kenaf::protocol::usarsim;

namespace {

std::vector<std::string> taken(LineSplitter& splitter) {
  std::vector<std::string> lines;
  while (const auto line = splitter.next()) lines.emplace_back(*line);
  return lines;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("Every line end that clients send") {
  for (const std::string end : {"\r\n", "\n", "\r", "\n\r", "\r\n\n"}) {
    LineSplitter splitter;
    CHECK(splitter.push("\r\n\nINIT {A 1}" + end + "DRIVE {B 2}" + end));
    CHECK(taken(splitter) == Lines{"INIT {A 1}", "DRIVE {B 2}"});
  }
}

TEST_CASE("Several requests in one send, and back to back without waiting") {
  LineSplitter splitter;
  splitter.push("GETSTARTPOSES\r\nINIT {ClassName USARBot.P2DX}\r\nDRI");
  CHECK(taken(splitter) == Lines{"GETSTARTPOSES", "INIT {ClassName USARBot.P2DX}"});
  splitter.push("VE {Left 1}\r\n");
  CHECK(taken(splitter) == Lines{"DRIVE {Left 1}"});
}

TEST_CASE("Cut into packets at every place, the lines are the same") {
  const std::string stream = "INIT {A 1}\r\nDRIVE {Left 1} {Right 2}\n\rGETGEO {Type Robot}\r\n";
  for (std::size_t first = 0; first <= stream.size(); ++first) {
    for (std::size_t second = first; second <= stream.size(); ++second) {
      LineSplitter splitter;
      Lines lines;
      for (const std::string& packet :
           {stream.substr(0, first), stream.substr(first, second - first), stream.substr(second)}) {
        REQUIRE(splitter.push(packet));
        for (std::string& line : taken(splitter)) lines.push_back(std::move(line));
      }
      REQUIRE(lines == Lines{"INIT {A 1}", "DRIVE {Left 1} {Right 2}", "GETGEO {Type Robot}"});
    }
  }
}

TEST_CASE("An unfinished line is not given out, a line may wait for the next push") {
  LineSplitter splitter;
  splitter.push("one\ntwo\nthr");
  CHECK(splitter.next() == "one");
  splitter.push("ee\n");
  CHECK(taken(splitter) == Lines{"two", "three"});
  CHECK_FALSE(splitter.next());
}

TEST_CASE("A line of 64 KiB is whole, one byte more is dropped, the next lines survive") {
  LineSplitter splitter;
  CHECK(splitter.push(std::string(kMaxLineBytes, 'a') + "\n"));
  CHECK(taken(splitter).at(0).size() == kMaxLineBytes);
  CHECK_FALSE(splitter.push("before\n" + std::string(kMaxLineBytes + 1, 'b') + "\nafter\n"));
  CHECK(taken(splitter) == Lines{"before", "after"});
  CHECK(splitter.dropped_lines() == 1);
}

TEST_CASE("A line that never ends is reported once and takes no more memory than a longest line") {
  LineSplitter splitter;
  int reports = 0;
  for (int i = 0; i < 10000; ++i) reports += splitter.push(std::string(1000, 'x')) ? 0 : 1;  // 10 MB
  CHECK(reports == 1);
  CHECK(splitter.dropped_lines() == 1);
  CHECK_FALSE(splitter.next());
  CHECK(splitter.push("x\nalive\n"));
  CHECK(taken(splitter) == Lines{"alive"});
}
