// What each candidate would do to the observed runs of a stage, along its range: a curve through the space of all bins,
// known at some values and straight between them. All fits are made on these curves, without further roll-outs.
//
// Thread safety: values and pure functions, apart from what the simulator does.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "gap/candidates/candidate.hpp"
#include "gap/diagnose/likelihood.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/diagnose/stage_data.hpp"

namespace kenaf::gap::diagnose {

struct CurvePoint {
  double value;  // of the candidate
  int column;    // of EffectCurves::shifts; -1: the present value, which shifts nothing
  bool exact;    // was simulated at the full rate, not with twice the time step
  // The effect does at once, somewhere between the point before and this one, what the two differ by: a command that is
  // faster than a dead band or not. What is between them is at neither place.
  bool jump = false;
};

struct EffectCurve {
  std::size_t candidate;           // its number
  std::vector<CurvePoint> points;  // by value
  // The largest length of the curve, in noise: below 1 these runs do not show the effect at any size.
  double visible = 0;
};

struct EffectCurves {
  std::span<const candidates::Candidate> candidates;  // must outlive this
  std::vector<EffectCurve> curves;                    // one for each candidate, in their order
  std::vector<Eigen::MatrixXd> shifts;                // varied minus nominal, of each group; one column for each point
};

// A candidate at a value.
struct Setting {
  std::size_t candidate;
  double value;
};
using Settings = std::vector<Setting>;  // together in one robot

// What a search asks of the simulator: what the groups shift by each of these settings.
using Simulate = std::function<std::vector<GroupVectors>(std::span<const Settings>, Fidelity)>;

// A number of the description that is off as far as such numbers ordinarily are; the present value of what is no
// number.
double ordinarily_off(const candidates::Candidate& candidate);

// No points but the present ones.
EffectCurves empty_curves(const StageData& data, std::span<const candidates::Candidate> candidates);

// For a first look: one point near the present value of each of `chosen`; of an effect that goes one way alone also the
// end of its range, of one that goes both ways one to the other side; of a number of the description instead one as
// near as such numbers ordinarily are off. Where that leads nowhere, as straight on to an end of the range it stays
// shorter than the gap, the end as well: a servo's torque suffices down to half of it.
void add_first_look(EffectCurves& curves, const StageData& data, std::span<const std::size_t> chosen,
                    const Simulate& simulate);
// Simulates points spread over the range of each of `chosen`, denser near the present value, where there are none.
void add_spread(EffectCurves& curves, const StageData& data, std::span<const std::size_t> chosen,
                const Simulate& simulate);
// A curve that moves little up to a value and much beyond it (drives that stall) is halved, up to four times, where it
// becomes as long as the gap: between points that are far apart a straight line hides where it goes. One that has done
// nearly all by its innermost point (drives that stall before it) gets points nearer to neutral, up to four, each a
// quarter of the way to the one before.
void follow_bends(EffectCurves& curves, const StageData& data, std::span<const std::size_t> chosen,
                  const Simulate& simulate);

// Leaves the curves of others than `kept` their present points alone: no search finds them.
void forget_all_but(EffectCurves& curves, std::span<const std::size_t> kept);

// Whether a curve moves little up to one of its points and is longer than `length` at the next: what it does between
// them is not known yet (commands below a dead band).
bool is_bent(const EffectCurves& curves, const StageData& data, std::size_t candidate, double length);

// Simulates points and adds them. One that is there at the same value is replaced.
void add_points(EffectCurves& curves, const StageData& data, std::span<const Setting> points, Fidelity fidelity,
                const Simulate& simulate);
// The same where the shifts of each point are known already.
void insert_points(EffectCurves& curves, const StageData& data, std::span<const Setting> points,
                   const std::vector<GroupVectors>& shifts, Fidelity fidelity);

// Length of a difference in noise alone: the root of the sum over bins of its square over their variance.
double squares_in_noise(const StageData& data, const GroupVectors& difference);
double length_in_noise(const StageData& data, const GroupVectors& difference);
// Likewise, of what the nominal robot leaves.
double gap_in_noise(const StageData& data);

}  // namespace kenaf::gap::diagnose
