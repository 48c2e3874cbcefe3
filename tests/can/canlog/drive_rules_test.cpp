// The rules of the loop: synchronous PDOs, power states, set-points, targets. Statuswords: 0x40 switch on disabled,
// 0x21 ready to switch on, 0x23 switched on, 0x27 operation enabled, 0x07 quick stop active, 0x0f fault reaction, 0x08
// fault. Controlwords: 0x06 shutdown, 0x07 switch on, 0x0f enable, 0x02 quick stop, 0x00 disable voltage, 0x80 fault
// reset.
#include <catch2/catch.hpp>

#include "can/canlog/power_transitions.hpp"
#include "tests/can/canlog/lines.hpp"

using namespace kenaf;
using namespace kenaf::canlog;
using canopen::PowerState;

TEST_CASE("A synchronous PDO comes once at each SYNC that is its own") {
  // the inclinometer's at each SYNC
  const Lines start{{0, "707#00"}, {1, "000#0107"}};
  const auto cycle = [](double ms) { return Lines{{ms, "080#"}, {ms + 1, "187#00000000"}}; };
  CHECK(broken(start + cycle(10) + cycle(20) + cycle(30)).empty());
  CHECK(broken(start + cycle(10) + Lines{{20, "080#"}} + cycle(30)) == Broken{"5: sync-pdo"});
  CHECK(broken(start + cycle(10) + Lines{{12, "187#00000000"}} + cycle(20)) == Broken{"5: sync-pdo"});
  // nobody asks a node that is not operational
  CHECK(broken({{0, "707#00"}, {10, "080#"}, {20, "080#"}}).empty());
  // SYNC was off for a while
  CHECK(broken(start + cycle(10) + cycle(500)).empty());
}

TEST_CASE("A PDO comes at each fifth SYNC, whichever of five that is") {
  // TPDO2 of a flipper. Its TPDO1 comes at each.
  Lines lines{{0, "703#00"}, {1, "000#0103"}};
  const auto run = [&lines](int cycles, const std::set<int>& with) {
    Lines all = lines;
    for (int i = 1; i <= cycles; ++i) {
      all.push_back({10.0 * i, "080#"});
      all.push_back({10.0 * i + 1, "183#400000000000"});
      if (with.contains(i)) all.push_back({10.0 * i + 2, "283#0000"});
    }
    return broken(all);
  };
  CHECK(run(12, {5, 10}).empty());
  CHECK(run(12, {2, 7, 12}).empty());  // which of five is the node's choice
  CHECK(run(12, {2, 6, 11}).size() == 1);
  CHECK(run(12, {2, 8}).size() == 1);
  CHECK(run(12, {6, 11}).size() == 1);  // not later than the fifth
}

TEST_CASE("A synchronous PDO comes within the window after SYNC") {
  const Lines cycle{{0, "707#05"}, {10, "080#"}, {13, "187#00000000"}, {20, "080#"}, {26, "187#00000000"}};
  CHECK(broken(cycle).empty());
  CheckOptions narrow;
  narrow.sync_window = std::chrono::milliseconds(5);
  CHECK(broken(cycle, narrow) == Broken{"5: sync-pdo"});
  // or as it was written, in us: 5000 = 0x1388
  const Lines written{{-2, "607#2307100088130000"}, {-1, "587#6007100000000000"}};
  Lines later = written + cycle;
  for (Line& line : later) line.ms += 10;
  CHECK(broken(later) == Broken{"7: sync-pdo"});
  // 0 ends it
  Lines ended = written + Lines{{-0.9, "607#2307100000000000"}, {-0.8, "587#6007100000000000"}} + cycle;
  for (Line& line : ended) line.ms += 10;
  CHECK(broken(ended).empty());
}

TEST_CASE("A drive is led to operation one transition at a time") {
  CHECK(broken({{0, "181#400000000000"},
                {5, "201#060000000000"},
                {10, "181#210000000000"},
                {15, "201#070000000000"},
                {20, "181#230000000000"},
                {25, "201#0F0000000000"},
                {30, "181#270000000000"},
                {35, "201#020000000000"},
                {40, "181#070000000000"},
                {45, "201#0F0000000000"},
                {50, "181#270000000000"}})
            .empty());
  // enable in "switch on disabled"
  CHECK(broken({{0, "181#400000000000"}, {5, "201#0F0000000000"}}) == Broken{"2: controlword"});
  CHECK(broken({{0, "181#400000000000"}, {5, "201#070000000000"}}) == Broken{"2: controlword"});
  // shutdown in "quick stop active"
  CHECK(broken({{0, "181#070000000000"}, {5, "201#060000000000"}}) == Broken{"2: controlword"});
  // a stop may always come
  CHECK(broken({{0, "181#080000000000"}, {5, "201#020000000000"}, {15, "201#000000000000"}}).empty());
  // the drive has just left the state in which this would have been right
  CHECK(broken({{0, "181#270000000000"}, {10, "181#080000000000"}, {10.5, "201#0F0000000000"}}).empty());
  CHECK(broken({{0, "181#270000000000"}, {10, "181#080000000000"}, {15, "201#0F0000000000"}}) ==
        Broken{"3: controlword"});
}

TEST_CASE("The table of orders is CiA 402's") {
  // every state in which an order means something, by its transitions: 2, 3, 4, 16, 5, 6, 8
  const auto states_of = [](DriveOrder order) {
    std::set<PowerState> states;
    for (int i = 0; i <= static_cast<int>(PowerState::fault); ++i)
      if (has_transition(static_cast<PowerState>(i), order)) states.insert(static_cast<PowerState>(i));
    return states;
  };
  using enum PowerState;
  CHECK(states_of(DriveOrder::shutdown) ==
        std::set{switch_on_disabled, ready_to_switch_on, switched_on, operation_enabled});
  CHECK(states_of(DriveOrder::switch_on) == std::set{ready_to_switch_on, switched_on, operation_enabled});
  CHECK(states_of(DriveOrder::enable) ==
        std::set{ready_to_switch_on, switched_on, operation_enabled, quick_stop_active});
  CHECK(states_of(DriveOrder::quick_stop).size() == 8);
}

TEST_CASE("A fault is reset by the edge of bit 7") {
  CHECK(broken({{0, "181#080000000000"}, {5, "201#800000000000"}, {10, "181#400000000000"}, {15, "201#060000000000"}})
            .empty());
  CHECK(broken({{0, "181#080000000000"},
                {5, "201#800000000000"},
                {10, "181#080000000000"},
                {15, "201#000000000000"},
                {25, "201#800000000000"}})
            .empty());
  CHECK(broken({{0, "181#080000000000"}, {5, "201#800000000000"}, {15, "201#800000000000"}}) ==
        Broken{"3: fault-reset"});
  CHECK(broken({{0, "181#270000000000"}, {5, "201#800000000000"}}) == Broken{"2: fault-reset"});
}

TEST_CASE("A drive goes from state to state by the transitions there are") {
  const auto goes = [](std::string_view from, std::string_view order, std::string_view to) {
    const auto status = [](std::string_view word) { return fmt::format("181#{}0000000000", word); };
    const std::string texts[] = {status(from), fmt::format("201#{}0000000000", order), status(to)};
    return broken({{0, texts[0]}, {5, texts[1]}, {10, texts[2]}});
  };
  // by itself: faults, and the way down
  CHECK(goes("27", "0F", "0F").empty());
  CHECK(goes("27", "0F", "08").empty());
  CHECK(goes("0F", "00", "08").empty());
  CHECK(goes("27", "0F", "07").empty());  // the master's heartbeat was lost
  CHECK(goes("07", "02", "40").empty());
  // by one order two transitions
  CHECK(goes("21", "0F", "27").empty());
  // up without an order
  CHECK(goes("40", "00", "21") == Broken{"3: statusword"});
  CHECK(goes("21", "06", "23") == Broken{"3: statusword"});
  CHECK(goes("07", "02", "27") == Broken{"3: statusword"});
  CHECK(goes("08", "00", "40") == Broken{"3: statusword"});
  // no transition at all
  CHECK(goes("40", "06", "23") == Broken{"3: statusword"});
  CHECK(goes("40", "06", "07") == Broken{"3: statusword"});
  CHECK(goes("08", "80", "21") == Broken{"3: statusword"});
  CHECK(goes("27", "0F", "00") == Broken{"3: statusword"});
  // 0x2f: no state
  CHECK(goes("40", "00", "01") == Broken{"3: statusword"});
  // an order by SDO is one too: 0x6040 = 6
  CHECK(broken({{0, "181#400000000000"},
                {1, "201#000000000000"},
                {5, "601#2B40600006000000"},
                {6, "581#6040600000000000"},
                {10, "181#210000000000"}})
            .empty());
  // statuswords are missing: so may states be
  CHECK(broken({{0, "181#400000000000"}, {10, "080#"}, {20, "080#"}, {30, "080#"}, {31, "181#270000000000"}}).empty());
}

TEST_CASE("A set-point is handed over by bits 4 and 12") {
  const Lines enabled{{0, "183#270000000000"}, {5, "203#0F0000000000"}};
  const Lines raised{{15, "203#3F00D0070000"}}, taken{{20, "183#271000000000"}}, lowered{{25, "203#2F00D0070000"}};
  const Lines released{{30, "183#270000000000"}}, next{{35, "203#3F00A00F0000"}};
  CHECK(broken(enabled + raised + taken + lowered + released + next).empty());
  CHECK(broken(enabled + raised + lowered) == Broken{"4: set-point"});
  CHECK(broken(enabled + raised + taken + lowered + next) == Broken{"6: set-point"});
  // a quick stop ends it
  CHECK(broken(enabled + raised + Lines{{25, "203#020000000000"}}).empty());
  // in homing the same bit starts it, and may fall at any time
  const Lines homing{{1, "603#2F60600006000000"}, {2, "583#6060600000000000"}};
  CHECK(broken(Lines{{0, "183#270000000000"}} + homing + Lines{{5, "203#0F0000000000"}} + raised + lowered).empty());
}

TEST_CASE("Before operation enabled a target is to stay") {
  CHECK(broken({{0, "181#400000000000"}, {5, "201#060000000000"}}).empty());
  CHECK(broken({{0, "181#400000000000"}, {5, "201#060001000000"}}) == Broken{"2: target"});
  CHECK(broken({{0, "181#270000000000"}, {5, "201#0F0001000000"}}).empty());
  CHECK(broken({{0, "181#270000000000"}, {5, "201#070001000000"}}) == Broken{"2: target"});
  // a flipper at 0x2710 = 10000 counts, 1 rad: within 100 counts of it
  CHECK(broken({{0, "183#400010270000"}, {5, "203#060010270000"}}).empty());
  CHECK(broken({{0, "183#400010270000"}, {5, "203#060070270000"}}).empty());
  CHECK(broken({{0, "183#400010270000"}, {5, "203#060000000000"}}) == Broken{"2: target"});
  CHECK(broken({{0, "183#270010270000"}, {5, "203#0F0000000000"}}).empty());
  // the drive's fault and the next target crossed on the wire
  const Lines fault{
      {0, "181#270000000000"}, {0.1, "183#270000000000"}, {10, "181#080000000000"}, {10.1, "183#080000000000"}};
  CHECK(broken(fault + Lines{{10.3, "201#0F00D0070000"}, {10.4, "203#0F00D0070000"}}).empty());
  // each an order and a target that are wrong
  CHECK(broken(fault + Lines{{12, "201#0F00D0070000"}, {12.1, "203#0F00D0070000"}}).size() == 4);
}

TEST_CASE("After a quick stop a track has no speed until it is enabled anew") {
  const Lines driven{{0, "181#270000000000"}, {5, "201#0F00D0070000"}, {15, "201#020000000000"}};
  CHECK(broken(driven + Lines{{25, "201#020000000000"}}).empty());
  CHECK(broken(driven + Lines{{16, "201#0F00D0070000"}}) == Broken{"4: target"});
  CHECK(broken(driven + Lines{{25, "201#02000A000000"}}) == Broken{"4: target"});
  CHECK(
      broken(
          driven +
          Lines{{20, "181#070000000000"}, {25, "201#0F0000000000"}, {30, "181#270000000000"}, {35, "201#0F00D0070000"}})
          .empty());
}
