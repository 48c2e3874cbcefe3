#include "can/canlog/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "can/canlog/bus_state.hpp"
#include "can/canlog/drive_frames.hpp"
#include "can/canlog/loop_span.hpp"
#include "can/canlog/wire_bits.hpp"

namespace kenaf::canlog {
namespace {

using canopen::FrameKind;
using canopen::Time;

constexpr double kGap = 1.5;  // periods

double seconds(Time time) {
  return std::chrono::duration<double>(time).count();
}

// Traffic between one SYNC and the next.
struct Cycle {
  Time sync_at;
  std::size_t frame;        // index of the SYNC in the log
  std::size_t clock_steps;  // as of that frame
  std::optional<Time> last_answer{}, last_command{};
  std::set<std::size_t> commanded{};  // drives
};

std::vector<Cycle> cycles_of(const Log& log, const Network& network) {
  std::vector<Cycle> cycles;
  BusState bus(network);
  for (std::size_t i = 0; i < log.frames.size(); ++i) {
    const LogFrame& logged = log.frames[i];
    if (logged.kind != FrameKind::data) continue;
    bus.on_frame(logged);
    if (canopen::is_sync(logged.frame)) cycles.push_back({logged.at, i, logged.clock_steps});
    if (cycles.empty() || cycles.back().clock_steps != logged.clock_steps) continue;
    Cycle& cycle = cycles.back();
    const Service service = bus.setup().address_of(logged.frame.id).service;
    if (service == Service::transmit_pdo) cycle.last_answer = logged.at;
    if (service == Service::receive_pdo) cycle.last_command = logged.at;
    if (const auto command = drive_command_from(logged.frame, bus.setup().pdo(logged.frame.id)))
      cycle.commanded.insert(command->drive);
  }
  return cycles;
}

Traffic traffic_of(const Log& log, std::size_t first, std::size_t last) {
  Traffic traffic;
  double bits = 0, worst_case = 0;
  for (std::size_t i = first; i < last; ++i) {  // without the last frame, which ends after the stretch
    const LogFrame& logged = log.frames[i];
    if (logged.kind != FrameKind::data || logged.clock_steps != log.frames[i + 1].clock_steps) continue;
    ++traffic.frames;
    bits += wire_bits(logged.frame);
    worst_case += worst_case_bits(logged.frame);
  }
  traffic.duration_s = seconds(log.frames[last].at - log.frames[first].at);
  if (traffic.duration_s <= 0) return traffic;
  traffic.frames_per_s = static_cast<double>(traffic.frames) / traffic.duration_s;
  traffic.bits_per_s = bits / traffic.duration_s;
  traffic.worst_case_bits_per_s = worst_case / traffic.duration_s;
  return traffic;
}

void add_sync(const std::vector<Cycle>& cycles, Figures& figures) {
  std::vector<double> intervals_s, jitter_s;
  for (std::size_t i = 1; i < cycles.size(); ++i) {
    if (cycles[i].clock_steps == cycles[i - 1].clock_steps)
      intervals_s.push_back(seconds(cycles[i].sync_at - cycles[i - 1].sync_at));
  }
  const auto intervals = spread_of(intervals_s);
  if (!intervals) return;
  figures.period_s = intervals->median_s;
  for (const double interval_s : intervals_s) {
    if (interval_s > kGap * *figures.period_s) {
      ++figures.gaps;
    } else {
      jitter_s.push_back(std::abs(interval_s - *figures.period_s));
    }
  }
  figures.sync_jitter = spread_of(std::move(jitter_s));
}

void add_cycle_times(const std::vector<Cycle>& cycles, Figures& figures) {
  std::vector<double> answers_s, commands_s;
  for (const Cycle& cycle : cycles) {
    if (cycle.last_answer) answers_s.push_back(seconds(*cycle.last_answer - cycle.sync_at));
    if (cycle.last_command) commands_s.push_back(seconds(*cycle.last_command - cycle.sync_at));
  }
  figures.answer_time = spread_of(std::move(answers_s));
  figures.command_time = spread_of(std::move(commands_s));
}

// True if each drive has got a command in this cycle or, if it takes only each n-th, in one of the n - 1 before. What
// lies before the log's begin or a step of its clock counts as having had one.
bool is_commanded(const std::vector<Cycle>& cycles, std::size_t at, const Network& network) {
  const std::vector<canbus::DriveOnBus>& drives = network.bus().drives;
  for (std::size_t drive = 0; drive < drives.size(); ++drive) {
    const auto turns = static_cast<std::size_t>(drives[drive].device.command_every);
    bool has_one = false;
    for (std::size_t before = 0; before < turns && !has_one; ++before) {
      const bool is_in_log = before <= at && cycles[at - before].clock_steps == cycles[at].clock_steps;
      has_one = !is_in_log || cycles[at - before].commanded.contains(drive);
    }
    if (!has_one) return false;
  }
  return true;
}

// Counts cycles that begin after the first motion and whose next SYNC comes before the last motion.
void add_late_commands(const Log& log, const Network& network, const std::vector<Cycle>& cycles, Figures& figures) {
  for (const LoopSpan& span : loop_spans(log, network)) {
    auto cycle = std::ranges::lower_bound(cycles, span.first, {}, &Cycle::frame);
    for (; cycle != cycles.end() && cycle + 1 != cycles.end() && (cycle + 1)->frame <= span.last; ++cycle) {
      if (cycle->clock_steps != (cycle + 1)->clock_steps) continue;
      ++figures.driven_cycles;
      if (!is_commanded(cycles, static_cast<std::size_t>(cycle - cycles.begin()), network)) ++figures.late_commands;
    }
  }
}

std::string traffic_line(std::string_view name, const Traffic& traffic, double bit_rate) {
  return fmt::format("{:<22}{:.3f} s, {} frames, {:.0f} frames/s, load {:.1f} % (at most {:.1f} %) of {:.0f} kbit/s\n",
                     name, traffic.duration_s, traffic.frames, traffic.frames_per_s,
                     100 * traffic.bits_per_s / bit_rate, 100 * traffic.worst_case_bits_per_s / bit_rate,
                     1e-3 * bit_rate);
}

std::string spread_line(std::string_view name, const std::optional<Spread>& spread) {
  if (!spread) return fmt::format("{:<22}none\n", name);
  return fmt::format("{:<22}median {:.3f} ms, 99 % {:.3f} ms, at most {:.3f} ms\n", name, 1e3 * spread->median_s,
                     1e3 * spread->p99_s, 1e3 * spread->max_s);
}

}  // namespace

std::optional<Spread> spread_of(std::vector<double> values_s) {
  if (values_s.empty()) return std::nullopt;
  std::ranges::sort(values_s);
  const auto at = [&](double share) {
    const double count = std::ceil(share * static_cast<double>(values_s.size()));
    return values_s[std::max<std::size_t>(1, static_cast<std::size_t>(count)) - 1];
  };
  return Spread{at(0.5), at(0.99), values_s.back()};
}

Figures figures_of(const Log& log, const Network& network) {
  Figures figures;
  if (log.frames.empty()) return figures;
  for (const LogFrame& logged : log.frames) {
    if (logged.kind == FrameKind::error) ++figures.error_messages;
    if (logged.kind != FrameKind::error && logged.kind != FrameKind::data) ++figures.other_frames;
  }
  figures.has_times = log.has_times;
  figures.clock_steps = log.clock_steps.size();
  figures.all = traffic_of(log, 0, log.frames.size() - 1);
  if (!log.has_times && log.frames.back().kind == FrameKind::data) ++figures.all.frames;
  const std::vector<Cycle> cycles = cycles_of(log, network);
  figures.cycles = cycles.size();
  if (cycles.size() > 1) figures.with_sync = traffic_of(log, cycles.front().frame, cycles.back().frame);
  add_sync(cycles, figures);
  add_cycle_times(cycles, figures);
  add_late_commands(log, network, cycles, figures);
  return figures;
}

std::string to_text(const Figures& figures, double bit_rate) {
  if (!figures.has_times) {
    return fmt::format("{:<22}{} frames, {} SYNC; the log has no times (record with `candump -L`)\n", "all",
                       figures.all.frames, figures.cycles);
  }
  std::string text = traffic_line("all", figures.all, bit_rate);
  if (figures.with_sync) text += traffic_line("first to last SYNC", *figures.with_sync, bit_rate);
  if (figures.period_s) {
    text += fmt::format("{:<22}{}, period {:.3f} ms, {} gaps\n", "SYNC", figures.cycles, 1e3 * *figures.period_s,
                        figures.gaps);
  }
  text += spread_line("SYNC jitter", figures.sync_jitter);
  text += spread_line("answers after SYNC", figures.answer_time);
  text += spread_line("commands after SYNC", figures.command_time);
  text += fmt::format("{:<22}{} of {} driven cycles\n", "late commands", figures.late_commands, figures.driven_cycles);
  if (figures.clock_steps > 0)
    text += fmt::format("{:<22}{}, not crossed by the figures above\n", "steps of the clock", figures.clock_steps);
  if (figures.other_frames > 0)
    text += fmt::format("{:<22}{}, not counted above\n", "not CANopen", figures.other_frames);
  if (figures.error_messages > 0) text += fmt::format("{:<22}{}\n", "driver's errors", figures.error_messages);
  return text;
}

}  // namespace kenaf::canlog
