// How far a simulation is from a measured run: of each channel and of all together, over time. Report and playback say
// the same of a run because both take it from here.
//
// Values are means over spans of time, as the diagnosis compares them (features.hpp), of the simulation that both pages
// draw: the whole run, with its commands, from its start. A difference is *measured minus simulated*: what has to be
// added to the simulation to get the robot, as in the dependences of report.json, whose slopes have that sign. It is
// counted in *times the noise* of its channel. The *worst moment* of a run is the span in which the nominal simulation
// is most times the noise off, root of the mean square over all channels.
//
// Thread safety: values and pure functions, except that compared_runs() runs the simulator.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnose/features.hpp"
#include "gap/diagnose/page/overlays.hpp"

namespace kenaf::gap::diagnose {

enum class FloorFrom { report, stated_noise, resolution };

// The noise of a channel: the difference below which it has no gap.
struct Floor {
  double value;  // 1 sigma of a mean over a full span, in the channel's unit, above 0
  FloorFrom from;
};

// Of each channel of a diagnosis, by column: what a report has (`reported`, empty without one); otherwise the noise
// that the dataset states for a sample, but at least the smallest difference that counts in a diagnosis.
std::map<std::string, Floor> floors_of(const std::map<std::string, double>& stated_noise,
                                       const std::map<std::string, double>& reported);
// Those that report.json is going to have: of each channel that of the first stage that compares it.
std::map<std::string, Floor> floors_of(const Diagnosis& d);

// One channel in one span.
struct ChannelMoment {
  std::size_t channel;         // of diagnosis_channels()
  double measured, simulated;  // means in its unit; angles are continuous
  double times_noise;          // their difference, without sign
  double difference() const { return measured - simulated; }
};

struct RunMoment {
  double at_s;                          // the middle of the span, or the run's end if that is earlier
  double times_noise;                   // rms over all channels
  std::vector<ChannelMoment> channels;  // most times the noise first, at least one
};

struct ChannelCourse {
  std::size_t channel;
  std::vector<double> difference, times_noise;  // of each span from the start, NaN where not measured; with sign
  double rms;                                   // of times_noise
};

struct RunGap {
  double span_s = 0;
  std::vector<ChannelCourse> channels;  // those that both have
  std::vector<RunMoment> moments;       // of the spans in which something was measured, in the order of time
  double rms = 0;                       // over all channels and spans, in times the noise
  std::optional<std::size_t> worst{};   // index into moments; empty if nothing can be compared

  const RunMoment* worst_moment() const { return worst ? &moments[*worst] : nullptr; }
};

// `map`: of the measured run, whose last time is `end_s` after its first. A span with fewer samples than the channel's
// fullest has more noise: that much less counts its difference.
RunGap gap_of_run(const FeatureMap& map, double end_s, const runs::Run& simulated,
                  const std::map<std::string, Floor>& floors);

// The noise of each bin of a map, 1 sigma.
Eigen::VectorXd noise_of_bins(const FeatureMap& map, const std::map<std::string, Floor>& floors);

struct ComparedRun {
  std::size_t run;  // of Observations::runs
  RunGap nominal;
  std::optional<RunGap> corrected;  // with corrections(), if there are any
};

// All runs of a diagnosis, in its order: those of the overlays with their simulations, the others simulated here.
// Without those that were never compared.
std::vector<ComparedRun> compared_runs(const Diagnosis& d, std::span<const Overlay> overlays);
// Those of the overlays alone: simulates nothing.
std::vector<ComparedRun> drawn_runs(const Diagnosis& d, std::span<const Overlay> overlays);

// The one with the worst moment of all; null if nothing was compared.
const ComparedRun* worst_run(std::span<const ComparedRun> runs);

// Those from which the corrected simulation is farther than the nominal one, by more than a tenth of it and of the
// noise, largest increase first.
std::vector<const ComparedRun*> worsened_runs(std::span<const ComparedRun> runs);

// "5.38 s", as the playback writes it: a half is rounded up.
std::string time_in_words(double t_s);
// "65 x noise".
std::string times_noise_in_words(double times);
// "gyro_z_radps: measured 1.2 rad/s, simulated 0.9 rad/s, difference 0.3 rad/s (150 x noise)".
std::string in_words(const ChannelMoment& moment);

}  // namespace kenaf::gap::diagnose
