// PDOs that the log itself moves to other identifiers, maps anew or makes invalid: frames are what they are then.
#include <catch2/catch.hpp>

#include "can/canlog/describe.hpp"
#include "can/canlog/figures.hpp"
#include "can/canlog/loop_span.hpp"
#include "tests/can/canlog/lines.hpp"

using namespace kenaf;
using namespace kenaf::canlog;

namespace {

// Writes to node 1, four bytes each, and their answers.
struct Written {
  std::uint16_t index;
  std::uint8_t sub;
  std::uint32_t value;
};

// Owns the lines' text.
class Text {
 public:
  explicit Text(const std::vector<Written>& writes) {
    for (const Written& one : writes) {
      const std::string object = fmt::format("{:02X}{:02X}{:02X}", one.index & 0xff, one.index >> 8, one.sub);
      const std::uint32_t value = one.value;
      frames_.push_back(fmt::format("601#23{}{:02X}{:02X}{:02X}{:02X}", object, value & 0xff, value >> 8 & 0xff,
                                    value >> 16 & 0xff, value >> 24));
      frames_.push_back(fmt::format("581#60{}00000000", object));
    }
  }
  Lines lines() const {
    Lines lines;
    for (const std::string& frame : frames_) lines.push_back({0.1 * static_cast<double>(lines.size()), frame});
    return lines;
  }

 private:
  std::vector<std::string> frames_;
};

std::string last_words(const Lines& lines) {
  return words_of(lines).back();
}

// Bit 30: no remote requests; bit 31: invalid.
const Text kMoved({{0x1800, 1, 0xc0000181}, {0x1800, 1, 0x400001e5}});
const Text kInvalid({{0x1800, 1, 0xc0000181}});
// TPDO1: position, then statusword
const Text kMapped({{0x1800, 1, 0xc0000181},
                    {0x1a00, 0, 0},
                    {0x1a00, 1, 0x60640020},
                    {0x1a00, 2, 0x60410010},
                    {0x1a00, 0, 2},
                    {0x1800, 1, 0x40000181}});
// RPDO1 of the left track moved to 0x310, which the predefined connection set has for RPDO2 of node 16
const Text kCommandMoved({{0x1400, 1, 0x80000201}, {0x1400, 1, 0x310}});

}  // namespace

TEST_CASE("A moved PDO is decoded at its new identifier, from the write on") {
  CHECK(last_words(kMoved.lines() + Lines{{10, "1E5#3702D2040000"}}) ==
        "track left: operation enabled, position 1234 counts (0.1234 m)");
  CHECK(last_words({{10, "1E5#3702D2040000"}}) == "node 101: TPDO1, not one of this robot's: 37 02 D2 04 00 00");
  CHECK(last_words(kMoved.lines() + Lines{{10, "181#3702D2040000"}}) ==
        "track left: TPDO1, not one of this robot's: 37 02 D2 04 00 00");
  // a reset takes it back
  CHECK(last_words(kMoved.lines() + Lines{{9, "701#00"}, {10, "181#3702D2040000"}}) ==
        "track left: operation enabled, position 1234 counts (0.1234 m)");
}

TEST_CASE("The rules follow a moved PDO") {
  CHECK(broken(kMoved.lines() + Lines{{10, "1E5#370200000000"}}).empty());
  CHECK(broken(kMoved.lines() + Lines{{10, "1E5#3702000000"}}) == Broken{"5: length"});
  CHECK(broken(kMoved.lines() + Lines{{10, "181#370200000000"}}) == Broken{"5: identifier"});
  CHECK(broken(kInvalid.lines() + Lines{{10, "181#370200000000"}}) == Broken{"3: identifier"});
  // 0x1e5 is TPDO1 of node 101 in the predefined connection set
  CHECK(broken({{10, "1E5#370200000000"}}) == Broken{"1: identifier"});
  // not operational: the frame is the left track's
  CHECK(broken(Lines{{0, "701#7F"}} + kMoved.lines() + Lines{{10, "1E5#370200000000"}}) == Broken{"6: nmt-state"});
  // a state that does not exist, 0x4f: what the drive shows is read there
  CHECK(broken(kMoved.lines() + Lines{{10, "1E5#6F0000000000"}}) == Broken{"5: statusword"});
}

TEST_CASE("A synchronous PDO is due at its new identifier") {
  const auto late = [](const Lines& lines) {
    std::vector<std::size_t> found;
    for (const Violation& one : check_rules(log_of(lines), easy_network())) {
      if (one.words.starts_with("TPDO1 of track left")) found.push_back(one.line);
    }
    return found;
  };
  const Lines start = kMoved.lines() + Lines{{5, "701#05"}, {10, "080#"}};
  CHECK(late(start + Lines{{11, "1E5#370200000000"}, {20, "080#"}, {21, "1E5#370200000000"}, {30, "080#"}}).empty());
  // the SYNC of line 6 has no answer
  CHECK(late(start + Lines{{20, "080#"}}) == std::vector<std::size_t>{6});
  CHECK(late(start + Lines{{11, "181#370200000000"}, {20, "080#"}}) == std::vector<std::size_t>{6});
}

TEST_CASE("An identifier that is not for PDOs is a finding, and takes nothing over") {
  const Text onto_heartbeats({{0x1800, 1, 0xc0000181}, {0x1800, 1, 0x40000701}});
  CHECK(broken(onto_heartbeats.lines() + Lines{{10, "701#7F"}}) == Broken{"4: pdo-setup"});
}

TEST_CASE("A PDO that the log maps anew is decoded as mapped") {
  CHECK(last_words(kMapped.lines() + Lines{{10, "181#D20400003702"}}) ==
        "track left: position 1234 counts (0.1234 m), operation enabled");
  // an entry of three bytes is no number: the bytes are shown
  const Text odd(
      {{0x1800, 1, 0xc0000181}, {0x1a00, 0, 0}, {0x1a00, 1, 0x20000118}, {0x1a00, 0, 1}, {0x1800, 1, 0x40000181}});
  CHECK(last_words(odd.lines() + Lines{{10, "181#010203"}}) == "track left: TPDO1: 01 02 03");
  CHECK(broken(odd.lines() + Lines{{10, "181#01020304"}}) == Broken{"11: length"});
}

TEST_CASE("Motion is seen in commands at a moved identifier") {
  const Lines motion{{9, "181#270000000000"}, {10, "310#0F0000000000"}, {20, "310#0F00D0070000"}};
  CHECK(last_words(kCommandMoved.lines() + motion) == "command track left: enable, 0.2 m/s");
  CHECK(loop_spans(log_of(kCommandMoved.lines() + motion), easy_network()).size() == 1);
  CHECK(loop_spans(log_of(motion), easy_network()).empty());
}

TEST_CASE("Where one node hears what another sends, the sender has the frame") {
  // RPDO1 of the left track listens to 0x182, TPDO1 of the right track
  const Text linked({{0x1400, 1, 0x80000201}, {0x1400, 1, 0x182}});
  CHECK(last_words(linked.lines() + Lines{{10, "182#3702D2040000"}}) ==
        "track right: operation enabled, position 1234 counts (-0.1234 m)");
}
