// The manoeuvre to drive next if a diagnosis leaves a choice between models: the gentlest and shortest one that
// suffices, its risk and its duration; or that none suffices.
//
// Candidates are the shipped manoeuvres that last at most 40 s and that the robot can drive. Each is simulated with the
// nominal robot and each rival as its operator drives it, which gives the worst-case risk; and under the nominal
// robot's commands with each rival as fitted and with each of its values moved, which gives the separation that a
// diagnosis would find, as it also compares models under equal commands.
//
// Chance events do not count as separation, however large they are:
// - bins are ignored from the time at which two rivals' tilts differ by more than kAnotherOutcome_rad: whether a robot
//   tips over an edge depends on unknown details, and so does all that follows;
// - a bin's weight decreases with its change under twice the time step, which is the simulator's own uncertainty;
// - each bin's contribution is limited (gap/diagnose/separation.hpp).
//
// Deterministic on any number of threads. Thread safety: pure functions.
#pragma once

#include <atomic>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnose/manoeuvre_risk.hpp"

namespace kenaf::gap::diagnose {

// One model that the verdict leaves open, as robot descriptions.
struct RivalModel {
  physics::RobotDescription fitted;
  // With each value moved slightly, one at a time, as values are refitted later. Only the direction matters, at any
  // distance: a difference that a value could absorb is no separation. Empty: values are fixed.
  std::vector<physics::RobotDescription> moved{};
};

struct ProposedManoeuvre {
  std::string manoeuvre, world;  // shipped names
  double duration_s;             // the longest of nominal robot and rivals
  // Smallest separation of any two rivals, in standard deviations, after refitting the values of both. If they are too
  // close before refitting, it is that separation, and `risk` and `duration_s` are the nominal robot's.
  double expected_score;
  bool suffices;  // expected_score reaches ProposalOptions::suffices_at and no robot fails
  bool is_flat;   // on level ground, not dropped
  Gentleness gentleness;
  Risk risk;
};

// Chosen: for two models d standard deviations apart, the more likely one is wrong with probability Phi(-d / 2): 0.13 %
// at 6, and 7 % if the true standard deviations are twice as large.
inline constexpr double kSuffices = 6;
// Chosen: 20 degrees, more than a changed value changes the same posture.
inline constexpr double kAnotherOutcome_rad = 0.35;

struct ProposalOptions {
  // For each of diagnosis_channels(): the standard deviation of a bin from noise and discrepancy together, in the
  // channel's unit; 0: never measured.
  std::vector<double> sigma_of_channel;
  double span_s;  // of a bin
  double suffices_at = kSuffices;
  unsigned threads = 0;  // 0: one per core
  const std::atomic<bool>* stop = nullptr;
};

// Best first: sufficient ones by gentleness, then duration; then the others, those in which no robot fails first, by
// score. Empty with fewer than two rivals.
//
// Not all are tried. Level ground comes first, ordered by the nominal robot's risk, then duration, until three of a
// class suffice or the class is exhausted; once one of a class suffices, no rougher class is tried. Obstacles are tried
// only if nothing on level ground suffices. So the list has the first three sufficient ones, or all of that class.
// Manoeuvres that the nominal robot fails are excluded.
//
// Throws std::invalid_argument unless `sigma_of_channel` has one number per channel and `span_s` > 0, Stopped
// (gap/diagnose/prediction.hpp) once `stop` is true.
std::vector<ProposedManoeuvre> propose_manoeuvres(const physics::RobotDescription& nominal,
                                                  std::span<const RivalModel> rivals, const ProposalOptions& options);

// "square (24 s, flat ground): separates them by 40 standard deviations; tilts by 2 degrees, no fall, 31 % of the stall
// current"
std::string in_words(const ProposedManoeuvre& proposed);
// A sentence about the whole list: which one to drive next, or that none suffices and which comes nearest.
std::string advice_in_words(std::span<const ProposedManoeuvre> proposed);

}  // namespace kenaf::gap::diagnose
