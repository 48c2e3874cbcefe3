// Which manoeuvre to drive next where a diagnosis leaves a choice between models: the gentlest and shortest one that
// suffices, what it risks and what it costs in time; or that none does.
//
// Candidates are the shipped manoeuvres that last at most 40 s and that the robot can drive. Each is simulated with the
// nominal robot and with each rival as its operator drives it, which says what it risks, the worst of all; and with the
// nominal robot's commands with each rival as it was fitted and with each of its values moved, which says by how much a
// diagnosis would tell the rivals apart: it too compares models under the same commands.
//
// What happens by chance does not count as separation, however far it goes:
// - nothing from the moment on at which two rivals tilt differently by more than kAnotherOutcome_rad: that one tips
// over an edge
//   and the other does not is settled by less than anybody knows, and all that follows with it;
// - a bin counts for less, the more twice the time step moves it: by that much the simulator does not know it;
// - and never for much (gap/diagnose/separation.hpp).
//
// Deterministic on any number of threads. Thread safety: pure functions.
#pragma once

#include <atomic>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnose/manoeuvre_risk.hpp"

namespace kenaf::gap::diagnose {

// One model that the verdict leaves open, as robots.
struct RivalModel {
  physics::RobotDescription fitted;
  // With each of its values moved a little, one at a time, for what the value may still do. Only the direction counts,
  // and it is followed however far: a value that could take up a difference is no separation. Empty: no value may
  // change.
  std::vector<physics::RobotDescription> moved{};
};

struct ProposedManoeuvre {
  std::string manoeuvre, world;  // shipped names
  double duration_s;             // the longest of nominal robot and rivals
  // Least separation of any two rivals, in standard deviations, after either may change its values. Where they are too
  // close before that already, this is how far apart they are then, and `risk` and `duration_s` are the nominal
  // robot's.
  double expected_score;
  bool suffices;  // expected_score reaches ProposalOptions::suffices_at and no robot fails
  bool is_flat;   // on level ground, not let fall
  Gentleness gentleness;
  Risk risk;
};

// Chosen: of two models d standard deviations apart the likelier one is the wrong one with a chance of Phi(-d / 2):
// 0.13 % at 6, and still only 7 % where the true standard deviations are twice what was stated.
inline constexpr double kSuffices = 6;
// Chosen: 20 degrees, more than a changed value makes of the same posture.
inline constexpr double kAnotherOutcome_rad = 0.35;

struct ProposalOptions {
  // Of each of diagnosis_channels(): the standard deviation of a bin, noise and what is left unexplained together, in
  // the channel's unit; 0: never measured.
  std::vector<double> sigma_of_channel;
  double span_s;  // of a bin
  double suffices_at = kSuffices;
  unsigned threads = 0;  // 0: one a core
  const std::atomic<bool>* stop = nullptr;
};

// Best first: those that suffice, by gentleness, then the shortest first; then those that do not, those in which no
// robot fails before the others, by score. Empty with fewer than two rivals.
//
// Not all are tried. Level ground comes first, in the order of what the nominal robot risks, then of its duration,
// until three of a class suffice or the class is through; once one of a class suffices, no rougher class is tried.
// Obstacles are tried only where nothing on level ground suffices. So of what suffices the first three are in the list,
// or as many as there are in that class. What the nominal robot already fails at is left out, nobody should drive it.
//
// Throws std::invalid_argument where `sigma_of_channel` has not one number for each channel or `span_s` is not above 0,
// Stopped (gap/diagnose/prediction.hpp) once `stop` is true.
std::vector<ProposedManoeuvre> propose_manoeuvres(const physics::RobotDescription& nominal,
                                                  std::span<const RivalModel> rivals, const ProposalOptions& options);

// "square (24 s, flat ground): separates them by 40 standard deviations; tilts by 2 degrees, no fall, 31 % of the stall
// current"
std::string in_words(const ProposedManoeuvre& proposed);
// Of the whole list, a sentence: which one to drive next, or that none suffices and what comes nearest.
std::string advice_in_words(std::span<const ProposedManoeuvre> proposed);

}  // namespace kenaf::gap::diagnose
