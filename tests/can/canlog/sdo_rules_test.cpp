// The rules of set-up: SDO transfers, their time and place, and the order in which PDOs are mapped.
#include <catch2/catch.hpp>

#include "tests/can/canlog/lines.hpp"

using namespace kenaf;
using namespace kenaf::canlog;

TEST_CASE("SDO: one transfer at a time, and the answer is the request's") {
  // two nodes may be asked at the same time
  CHECK(broken({{0, "601#4000100000000000"},
                {1, "602#4000100000000000"},
                {2, "582#4300100092010200"},
                {3, "581#4300100092010200"}})
            .empty());
  CHECK(broken({{0, "601#4000100000000000"}, {1, "601#4000100000000000"}, {2, "581#4300100092010200"}}) ==
        Broken{"2: sdo-dialogue"});
  // another object; another sub-index; an answer to a write; none was asked for
  CHECK(broken({{0, "601#4000100000000000"}, {1, "581#4301100092010200"}, {2, "581#4300100092010200"}}) ==
        Broken{"2: sdo-dialogue"});
  CHECK(broken({{0, "601#4018100100000000"}, {1, "581#4318100292010200"}, {2, "581#4318100192010200"}}) ==
        Broken{"2: sdo-dialogue"});
  CHECK(broken({{0, "601#4000100000000000"}, {1, "581#6000100000000000"}, {2, "581#4300100092010200"}}) ==
        Broken{"2: sdo-dialogue"});
  CHECK(broken({{0, "601#4000100000000000"}, {1, "581#4300100092010200"}, {2, "581#4300100092010200"}}) ==
        Broken{"3: sdo-dialogue"});
  // the request may have been before the log
  CHECK(broken({{1, "581#4300100092010200"}}).empty());
  // an abort is an answer to anything
  CHECK(broken({{0, "601#4000100000000000"},
                {1, "581#8000100000000206"},
                {2, "601#4000100000000000"},
                {3, "601#8000100000000405"}})
            .empty());
}

TEST_CASE("SDO in segments: toggle bits alternate, on both sides alike") {
  // the device name, ten bytes: seven, then three (no more: bit 0; four of seven without data: 100 in bits 3 to 1)
  const Lines begin{{0, "601#4008100000000000"}, {1, "581#410810000A000000"}, {2, "601#6000000000000000"}};
  const Lines first{{3, "581#0041424344454647"}};
  CHECK(broken(begin + first + Lines{{4, "601#7000000000000000"}, {5, "581#1948494A00000000"}}).empty());
  CHECK(broken(begin + Lines{{3, "581#1041424344454647"}, {4, "581#0041424344454647"}}) == Broken{"4: sdo-dialogue"});
  CHECK(broken(begin + first + Lines{{4, "601#6000000000000000"}, {5, "581#0948494A00000000"}}) ==
        Broken{"5: sdo-dialogue"});
  // given up half-way, without an abort
  CHECK(broken(begin + first + Lines{{4, "601#4000100000000000"}, {5, "581#4300100092010200"}}) ==
        Broken{"5: sdo-dialogue"});
  // its transfer may have begun before the log, or not at all
  CHECK(broken({{0, "601#6000000000000000"}}).empty());
  CHECK(broken({{0, "701#00"}, {1, "601#6000000000000000"}}) == Broken{"2: sdo-dialogue"});
  // a write of five bytes in segments
  CHECK(broken({{0, "601#2108100005000000"},
                {1, "581#6008100000000000"},
                {2, "601#0541424344450000"},
                {3, "581#2000000000000000"}})
            .empty());
}

TEST_CASE("SDO requests are answered in time") {
  // the description gives 0.5 s
  CHECK(broken({{0, "601#4000100000000000"}, {500, "581#4300100092010200"}}).empty());
  CHECK(broken({{0, "601#4000100000000000"}, {501, "581#4300100092010200"}}) == Broken{"1: sdo-time"});
  CHECK(broken({{0, "601#4000100000000000"}, {900, "080#"}}) == Broken{"1: sdo-time"});
  CHECK(broken({{0, "601#4000100000000000"}, {400, "080#"}}).empty());  // the log ends
  CheckOptions quick;
  quick.sdo_answer = std::chrono::milliseconds(10);
  CHECK(broken({{0, "601#4000100000000000"}, {11, "581#4300100092010200"}}, quick) == Broken{"1: sdo-time"});
}

namespace {

// Writes of node 1 and their answers, a millisecond apart.
struct Write {
  std::uint16_t index;
  std::uint8_t sub;
  std::uint32_t value;
};
std::vector<std::string> sdo_lines(const std::vector<Write>& writes) {
  std::vector<std::string> out;
  for (const Write& write : writes) {
    canopen::Frame request{.id = 0x601, .length = 8}, answer{.id = 0x581, .length = 8};
    request.data[0] = 0x23;
    canopen::put(request.data, 1, 2, write.index);
    request.data[3] = write.sub;
    answer.data = request.data;
    answer.data[0] = 0x60;
    canopen::put(request.data, 4, 4, write.value);
    out.push_back(candrives::text(request));
    out.push_back(candrives::text(answer));
  }
  return out;
}

// The rules broken by these writes, numbered from 1 on, and by the start of the node after them.
Broken broken_writes(const std::vector<Write>& writes) {
  const std::vector<std::string> texts = sdo_lines(writes);
  Lines lines{{0, "701#00"}};
  for (std::size_t i = 0; i < texts.size(); ++i) lines.push_back({1.0 + static_cast<double>(i), texts[i]});
  lines.push_back({100, "000#0101"});
  Broken found;
  for (const Violation& one : check_rules(log_of(lines), easy_network())) {
    const std::string where = one.line == lines.size() ? "start" : fmt::format("write {}", (one.line - 1) / 2);
    found.push_back(fmt::format("{}: {}", where, one.rule.name));
  }
  return found;
}

constexpr Write kOff{0x1800, 1, 0xc0000181}, kEmpty{0x1a00, 0, 0}, kStatus{0x1a00, 1, 0x60410010},
    kPosition{0x1a00, 2, 0x60640020}, kCount{0x1a00, 0, 2}, kOn{0x1800, 1, 0x40000181};

}  // namespace

TEST_CASE("A PDO is mapped in the order of CiA 301, 7.5.2.38") {
  CHECK(broken_writes({kOff, {0x1800, 2, 1}, kEmpty, kStatus, kPosition, kCount, kOn}).empty());
  CHECK(broken_writes({kOff}).empty());  // switched off, and that is all
  CHECK(broken_writes({kEmpty, kStatus, kPosition, kCount}) ==
        Broken{"write 1: pdo-setup", "write 2: pdo-setup", "write 3: pdo-setup", "write 4: pdo-setup"});
  CHECK(broken_writes({kOff, kStatus, kPosition, kCount, kOn}) == Broken{"write 2: pdo-setup", "write 3: pdo-setup"});
  CHECK(broken_writes({kOff, kEmpty, kStatus, kPosition, kCount}) == Broken{"start: pdo-setup"});
  CHECK(broken_writes({kOff, kEmpty, kStatus, kPosition, kCount, kOn, kEmpty}) == Broken{"write 7: pdo-setup"});
  CHECK(broken_writes({kOn, {0x1800, 1, 0x40000182}}) == Broken{"write 2: pdo-setup"});
  CHECK(broken_writes({kOn, {0x1800, 3, 100}}) == Broken{"write 2: pdo-setup"});
  // 32 + 32 + 16 bits
  CHECK(broken_writes({kOff,
                       kEmpty,
                       {0x1a00, 1, 0x60640020},
                       {0x1a00, 2, 0x606c0020},
                       {0x1a00, 3, 0x60410010},
                       {0x1a00, 0, 3},
                       kOn}) == Broken{"write 6: pdo-setup"});
}

TEST_CASE("A PDO has the length that it was mapped with, whatever the description says") {
  std::vector<std::string> texts = sdo_lines({kOff, kEmpty, kStatus, {0x1a00, 0, 1}, kOn});
  Lines lines;
  for (const std::string& text : texts) lines.push_back({static_cast<double>(lines.size()), text});
  CHECK(broken(lines + Lines{{100, "181#3702"}}).empty());
  CHECK(broken(lines + Lines{{100, "181#370200000000"}}) == Broken{"11: length"});
}

TEST_CASE("No SDO is sent from the first motion to the last") {
  const Lines enabled{{0, "181#270000000000"}, {1, "201#0F0000000000"}};
  const Lines ask{{20, "602#4000100000000000"}, {21, "582#4300100092010200"}};
  const Lines go{{10, "201#0F00D0070000"}}, go_on{{30, "201#0F00D0070000"}}, stop{{40, "201#0F0000000000"}};
  CHECK(broken(enabled + ask + go_on + stop).empty());
  CHECK(broken(enabled + go + ask + stop).empty());
  CHECK(broken(enabled + go + ask + go_on + stop) == Broken{"4: sdo-in-loop"});
  // a reset between them: two runs, and the set-up of the second
  CHECK(broken(enabled + go + Lines{{15, "000#8200"}, {16, "701#00"}, {17, "702#00"}} + ask +
               Lines{{25, "000#0100"}, {30, "181#270000000000"}, {31, "201#0F00D0070000"}})
            .empty());
  // a flipper's set-point is a motion, and homing is none
  const Lines flipper{{0, "183#270000000000"}, {1, "203#0F0000000000"}};
  const Lines edges{{10, "203#3F0010000000"}, {20, "183#271010000000"}, {30, "203#2F0010000000"}};
  const Lines ask_again{{50, "602#4000100000000000"}, {51, "582#4300100092010200"}};
  const Lines released{{60, "183#270010000000"}, {70, "203#3F0020000000"}};
  CHECK(broken(flipper + edges + ask_again + released) == Broken{"6: sdo-in-loop"});
  const Lines homing{{5, "603#2F60600006000000"}, {6, "583#6060600000000000"}};
  CHECK(broken(flipper + homing + edges + ask_again + released).empty());
}
