// The set-point handshake, cycle by cycle. CiA 402-2, profile position mode: the drive takes the target at the rising
// edge of bit 4 of the controlword, acknowledges with bit 12 of the statusword, and takes bit 12 back once bit 4 is low
// again.
#include <catch2/catch.hpp>

#include "can/canopen/drive.hpp"

using namespace kenaf::canopen;

namespace {

constexpr std::uint16_t kEnabled = 0x0237;       // operation enabled, bit 12 low
constexpr std::uint16_t kAcknowledged = 0x1237;  // bit 12 high
constexpr std::uint16_t kLow = 0x0020;           // change at once alone
constexpr std::uint16_t kHigh = 0x0030;          // and a new set-point

// A drive of those rules that answers `delay` cycles late.
struct LateDrive {
  int delay;
  std::int32_t target = 0;
  int edges = 0;

  std::uint16_t cycle(std::uint16_t control, std::int32_t new_target) {
    const bool high = (control & 0x10) != 0;
    if (high && !was_high) {
      target = new_target;
      ++edges;
    }
    if (high != was_high) since = 0;
    was_high = high;
    if (since++ >= delay) acknowledges = high;
    return acknowledges ? kAcknowledged : kEnabled;
  }

  bool was_high = false, acknowledges = false;
  int since = 0;
};

}  // namespace

TEST_CASE("A target is handed over by bit 4, until it is acknowledged") {
  SetPointHandshake handshake;
  CHECK(handshake.step(1000, kEnabled) == kHigh);  // the edge
  CHECK(handshake.step(1000, kEnabled) == kHigh);  // not acknowledged yet: stays up
  CHECK(handshake.step(1000, kAcknowledged) == kLow);
  CHECK(handshake.step(1000, kAcknowledged) == kLow);  // bit 12 not taken back yet
  CHECK(handshake.step(1000, kEnabled) == kLow);
  CHECK(handshake.step(1000, kEnabled) == kLow);  // the same target: no new edge
}

TEST_CASE("The first target is handed over, be it 0") {
  SetPointHandshake handshake;
  CHECK(handshake.step(0, kEnabled) == kHigh);
}

TEST_CASE("Of an acknowledgement that was there before, the end is waited for") {
  SetPointHandshake handshake;
  CHECK(handshake.step(5, kAcknowledged) == kLow);
  CHECK(handshake.step(5, kAcknowledged) == kLow);
  CHECK(handshake.step(5, kEnabled) == kHigh);
}

TEST_CASE("A new target gets an edge of its own") {
  SetPointHandshake handshake;
  CHECK(handshake.step(1, kEnabled) == kHigh);
  CHECK(handshake.step(1, kAcknowledged) == kLow);
  CHECK(handshake.step(1, kEnabled) == kLow);
  CHECK(handshake.step(2, kEnabled) == kHigh);
  CHECK(handshake.step(2, kAcknowledged) == kLow);
  CHECK(handshake.step(1, kEnabled) == kHigh);  // and so does an old one that is wanted again
}

TEST_CASE("A target that changes while the handshake is under way is handed over after it") {
  SetPointHandshake handshake;
  SECTION("before the acknowledgement: bit 4 must fall first") {
    CHECK(handshake.step(1, kEnabled) == kHigh);
    CHECK(handshake.step(2, kEnabled) == kHigh);  // no edge: the drive has 1, or perhaps 2
    CHECK(handshake.step(2, kAcknowledged) == kLow);
    CHECK(handshake.step(2, kEnabled) == kHigh);  // now it surely gets 2
    CHECK(handshake.step(2, kAcknowledged) == kLow);
    CHECK(handshake.step(2, kEnabled) == kLow);
  }
  SECTION("after it: bit 12 must fall first") {
    CHECK(handshake.step(1, kEnabled) == kHigh);
    CHECK(handshake.step(1, kAcknowledged) == kLow);
    CHECK(handshake.step(2, kAcknowledged) == kLow);
    CHECK(handshake.step(3, kAcknowledged) == kLow);
    CHECK(handshake.step(3, kEnabled) == kHigh);  // 2 is left out
  }
  SECTION("and back again: nothing to hand over") {
    CHECK(handshake.step(1, kEnabled) == kHigh);
    CHECK(handshake.step(2, kEnabled) == kHigh);
    CHECK(handshake.step(1, kAcknowledged) == kLow);
    CHECK(handshake.step(1, kEnabled) == kLow);
  }
}

TEST_CASE("Drives quick and late get the last target, with one edge for each handshake") {
  for (const int delay : {0, 1, 2, 7}) {
    INFO("acknowledges " << delay << " cycles late");
    SetPointHandshake handshake;
    LateDrive drive{delay};
    std::uint16_t status = kEnabled;
    const auto cycle = [&](std::int32_t target) {
      status = drive.cycle(static_cast<std::uint16_t>(kControlEnable | handshake.step(target, status)), target);
    };
    for (int i = 0; i < 100; ++i) cycle(i);  // a target that changes every cycle
    const int moving_edges = drive.edges;
    // a handshake takes at least: up and acknowledged, down and taken back, each `delay` + 1 cycles
    CHECK(moving_edges == (100 + 2 * delay + 1) / (2 * (delay + 1)));
    for (int i = 0; i < 4 * (delay + 1); ++i) cycle(-42);
    CHECK(drive.target == -42);
    const int edges = drive.edges;
    for (int i = 0; i < 50; ++i) cycle(-42);
    CHECK(drive.edges == edges);
  }
}
