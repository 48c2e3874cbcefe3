// Logs that begin in the middle of something: what was before them is not judged.
#include <catch2/catch.hpp>

#include "tests/can/canlog/lines.hpp"

using namespace kenaf;
using namespace kenaf::canlog;

namespace {

// Node 3 writes TPDO2's mapping entries, its count, and makes it valid again.
const Lines kRestOfSetUp{{0, "603#23011A0120006460"}, {1, "583#60011A0100000000"}, {2, "603#2F011A0001000000"},
                         {3, "583#60011A0000000000"}, {4, "603#2301180183020040"}, {5, "583#6001180100000000"}};

}  // namespace

TEST_CASE("A set-up of PDOs that began before the log is not judged") {
  CHECK(broken(kRestOfSetUp).empty());
  CHECK(broken({{0, "603#2B01180364000000"}, {1, "583#6001180300000000"}}).empty());  // an inhibit time
  // after a reset the PDO is valid until the log makes it invalid
  CHECK(broken(Lines{{0, "703#00"}} + kRestOfSetUp) == Broken{"3: pdo-setup", "3: pdo-setup", "5: pdo-setup"});
  // valid in the log, then mapped
  CHECK(broken(kRestOfSetUp + Lines{{6, "603#2F011A0000000000"}, {7, "583#60011A0000000000"}}) ==
        Broken{"8: pdo-setup"});
}

TEST_CASE("A transfer that began before the log is not judged") {
  // segments of a read and their requests
  CHECK(broken({{0, "601#7000000000000000"},
                {1, "581#1041424344454647"},
                {2, "601#6000000000000000"},
                {3, "581#0148494A00000000"},
                {4, "601#4000100000000000"},
                {5, "581#4300100092010200"}})
            .empty());
  // the answer to the last request before the log, and one more of another transfer
  CHECK(broken({{0, "581#4300100092010200"}, {1, "601#4000100000000000"}, {2, "581#4300100092010200"}}).empty());
}

TEST_CASE("A block download that began before the log is not judged") {
  // segments 33 to 36 look like writes, 66 like an abort and 98 like segments asked for
  for (const int first : {1, 33, 63, 94, 120}) {
    Lines lines;
    std::vector<std::string> frames;
    for (int number = first; number <= 127; ++number)
      frames.push_back(fmt::format("601#{:02X}41424344454647", number == 127 ? 0xff : number));
    for (const std::string& frame : frames) lines.push_back({0, frame});
    INFO(first);
    CHECK(broken(lines + Lines{{1, "581#A27F7F0000000000"},
                               {2, "601#C100000000000000"},
                               {3, "581#A100000000000000"},
                               {4, "601#4000100000000000"},
                               {5, "581#4300100092010200"}})
              .empty());
  }
  // only the last segment, 0x82 or 0xc2
  for (const std::string_view last : {"601#8241000000000000", "601#C241000000000000"}) {
    CHECK(broken({{0, last}, {1, "581#A2027F0000000000"}, {2, "601#D900000000000000"}, {3, "581#A100000000000000"}})
              .empty());
  }
}

TEST_CASE("A block upload that began before the log is not judged") {
  CHECK(broken({{0, "581#2141424344454647"},
                {1, "581#2241424344454647"},
                {2, "581#E341424344454647"},
                {3, "601#A2237F0000000000"},
                {4, "581#C100000000000000"},
                {5, "601#A100000000000000"},
                {6, "601#4000100000000000"},
                {7, "581#4300100092010200"}})
            .empty());
}
