// Bits on the wire and times of cycles, by hand.
#include "can/canlog/figures.hpp"

#include <catch2/catch.hpp>

#include "can/canlog/wire_bits.hpp"
#include "tests/can/canlog/lines.hpp"

using namespace kenaf;
using namespace kenaf::canlog;
using candrives::frame;

// The message from the start of frame to the data's end is a polynomial, its last bit x^0; its CRC is that times x^15,
// modulo x^15 + 0x4599. By hand, each power from the one before: x^15 = 0x4599; shifted left by one, and where bit 15
// comes out, less 0xc599:
//   x^16 0x4eab  x^17 0x58cf  x^18 0x7407  x^19 0x2d97  x^20 0x5b2e  x^21 0x73c5  x^22 0x2213  x^23 0x4426
//   x^24 0x4dd5  x^25 0x5e33  x^26 0x79ff  x^27 0x3667  x^28 0x6cce  x^29 0x1c05

TEST_CASE("A SYNC has the CRC and the stuff bits that were worked out by hand") {
  // 0 00010000000 000 0000: 19 bits, the fifth is 1: x^14. CRC = x^29.
  CHECK(crc_of(frame("080#")) == 0x1c05);
  // 0000 1 00000000000000 | 00 111 0000000 101: of the 16 zeros after the first 1 the 5th, 10th and 15th are followed
  // by a stuff bit, and of the seven in the CRC the 5th: 4 in all.
  CHECK(stuff_bits(frame("080#")) == 4);
  CHECK(wire_bits(frame("080#")) == 47 + 4);
}

TEST_CASE("A stuff bit is the first of the next five") {
  // All 34 bits are 0, the CRC of nothing but zeros too: a stuff bit after each five, 6 in all.
  CHECK(crc_of(frame("000#")) == 0);
  CHECK(stuff_bits(frame("000#")) == 6);
  // ... 0001 00000001: x^8 and x^0. CRC = x^23 + x^15 = 0x4426 ^ 0x4599.
  CHECK(crc_of(frame("000#01")) == 0x01bf);
  // 18 zeros: 3; 1; 7 zeros: 1; 1; then 000000 11 0 111111: 1 among the six zeros, 1 among the six ones.
  CHECK(stuff_bits(frame("000#01")) == 6);
}

TEST_CASE("No frame has more stuff bits than the worst case has") {
  unsigned random = 1;
  const auto next = [&random] { return random = 1664525u * random + 1013904223u; };
  for (int i = 0; i < 20'000; ++i) {
    canopen::Frame one{.id = static_cast<std::uint16_t>(next() >> 21),
                       .length = static_cast<std::uint8_t>((next() >> 24) % 9)};
    // long runs, where stuff bits are many
    for (std::uint8_t k = 0; k < one.length; ++k)
      one.data[k] = (next() >> 30) == 0 ? 0x3c : static_cast<std::uint8_t>(next() >> 31 ? 0 : 0xf0);
    REQUIRE(wire_bits(one) <= worst_case_bits(one));
    REQUIRE(wire_bits(one) >= 47 + 8 * one.length);
  }
}

TEST_CASE("The spread of some times is their median, 99th percentile and maximum") {
  CHECK_FALSE(spread_of({}));
  CHECK(spread_of({3})->max_s == 3);
  std::vector<double> values;
  for (int i = 200; i > 0; --i) values.push_back(i);
  CHECK(spread_of(values)->median_s == 100);
  CHECK(spread_of(values)->p99_s == 198);
  CHECK(spread_of(values)->max_s == 200);
}

TEST_CASE("SYNC's period and jitter, answers and commands after it") {
  const Figures figures = figures_of(log_of({{0, "080#"},
                                             {1, "181#370200000000"},
                                             {2, "187#00000000"},
                                             {3, "201#0F0000000000"},
                                             {10, "080#"},
                                             {11.5, "181#370200000000"},
                                             {20.5, "080#"},
                                             {30, "080#"},
                                             {90, "080#"},  // SYNC was switched off
                                             {95, "201#0F0000000000"}}),
                                     easy_network());
  CHECK(figures.cycles == 5);
  // intervals 10, 10.5, 9.5, 60
  CHECK(*figures.period_s == Approx(0.010));
  CHECK(figures.gaps == 1);
  CHECK(figures.sync_jitter->median_s == Approx(0.0005));
  CHECK(figures.sync_jitter->max_s == Approx(0.0005));
  CHECK(figures.answer_time->median_s == Approx(0.0015));
  CHECK(figures.answer_time->max_s == Approx(0.002));
  CHECK(figures.command_time->max_s == Approx(0.005));
  CHECK(figures.driven_cycles == 0);
}

TEST_CASE("The load is that of the bits there are") {
  // Ten SYNCs of 51 bits in 10 ms, the last one beyond: 500 kbit/s carry 5000 bits in that time.
  Lines lines;
  for (int i = 0; i <= 10; ++i) lines.push_back({1.0 * i, "080#"});
  lines.push_back({10, "12345678#00"});
  const Figures figures = figures_of(log_of(lines), easy_network());
  CHECK(figures.with_sync->frames == 10);
  CHECK(figures.with_sync->bits_per_s == Approx(51'000));
  CHECK(figures.with_sync->worst_case_bits_per_s == Approx(55'000));
  CHECK(figures.with_sync->frames_per_s == Approx(1000));
  CHECK(figures.other_frames == 1);
  CHECK_THAT(to_text(figures, 500e3), Catch::Contains("load 10.2 % (at most 11.0 %) of 500 kbit/s"));
}

TEST_CASE("A drive that takes each third command is late only without any in three cycles") {
  canbus::RobotBus bus = candrives::easy_robot();
  bus.drives.resize(2);
  bus.drives[0].device.command_every = 3;
  const auto figures_without = [&](int lost_cycle) {
    std::string text;
    for (int cycle = 0; cycle < 16; ++cycle) {
      const auto add = [&](double after_ms, std::string_view frame) {
        text += fmt::format("({:.6f}) vcan0 {}\n", 1e-3 * (10 * cycle + after_ms), frame);
      };
      add(0, "080#");
      add(1, "181#270200000000");
      add(2, "182#270200000000");
      if (cycle % 3 == 0 && cycle != lost_cycle) add(4, "201#0F00E8030000");
      add(5, "202#0F0018FCFFFF");
    }
    return figures_of(log_from(text), Network(bus));
  };
  // Driven from cycle 0, whose first command comes after its SYNC, to that of cycle 15: 14 whole ones, from SYNC 1 on.
  const Figures all = figures_without(-1);
  CHECK(all.driven_cycles == 14);
  CHECK(all.late_commands == 0);
  // Node 1 has a command in cycle 3 and the next in 9: late are 6, 7 and 8.
  const Figures lost = figures_without(6);
  CHECK(lost.driven_cycles == 14);
  CHECK(lost.late_commands == 3);
}
