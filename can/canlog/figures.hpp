// Statistics of a recorded bus: load, regularity of SYNC, answer times.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "can/canlog/log.hpp"
#include "can/canlog/network.hpp"

namespace kenaf::canlog {

// Percentiles of a set of times.
struct Spread {
  double median_s = 0, p99_s = 0, max_s = 0;
};
// Median and p99: the smallest value not less than 50 % and 99 % of all values, respectively; nullopt for none.
std::optional<Spread> spread_of(std::vector<double> values_s);

// A stretch of the log, from the start of its first frame to that of its last; frames before a step of the recorder's
// clock do not count.
struct Traffic {
  double duration_s = 0;
  std::size_t frames = 0;
  double frames_per_s = 0;
  double bits_per_s = 0;             // with the stuff bits of each frame
  double worst_case_bits_per_s = 0;  // with the maximum of stuff bits for its length
};

struct Figures {
  Traffic all;
  std::optional<Traffic> with_sync;  // from the first SYNC to the last: the loop, with power-up and shutdown
  std::size_t other_frames = 0;      // kinds that CANopen does not use; not in the traffic
  std::size_t error_messages = 0;    // of the CAN driver
  bool has_times = true;             // false: only numbers of frames mean something
  std::size_t clock_steps = 0;       // of the recorder's clock, backwards: no figure crosses one

  std::size_t cycles = 0;              // SYNCs
  std::optional<double> period_s;      // median of the times between two SYNCs
  std::size_t gaps = 0;                // longer than 1.5 periods: excluded from the jitter
  std::optional<Spread> sync_jitter;   // deviation of the others from the period
  std::optional<Spread> answer_time;   // SYNC to the last TPDO of its cycle
  std::optional<Spread> command_time;  // SYNC to the last RPDO of its cycle
  std::size_t driven_cycles = 0;       // from the first motion to the last
  std::size_t late_commands = 0;       // of these, without a new command to a drive whose turn it was
};
Figures figures_of(const Log& log, const Network& network);

// Formats the figures as lines of text. `bit_rate` in bits per second.
std::string to_text(const Figures& figures, double bit_rate);

}  // namespace kenaf::canlog
