// The effect of each candidate on the observed runs of a stage along its range: a curve in the space of all bins, known
// at some values and linear in between. Fits use these curves and need no further roll-outs.
//
// Thread safety: values and pure functions, except that the simulator runs.
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
  bool exact;    // simulated at the full rate, not with twice the time step
  // The effect jumps somewhere between the previous point and this one, as when a command exceeds a dead band. Values
  // in between are never interpolated.
  bool jump = false;
};

struct EffectCurve {
  std::size_t candidate;           // its number
  std::vector<CurvePoint> points;  // by value
  // Largest length of the curve, in units of noise: below 1 these runs show the effect at no size.
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

// The interface of a search to the simulator: returns the groups' shifts for each of the settings.
using Simulate = std::function<std::vector<GroupVectors>(std::span<const Settings>, Fidelity)>;

// The value of a number of the description with an ordinary error; the present value of other candidates.
double ordinarily_off(const candidates::Candidate& candidate);

// Curves with their present points only.
EffectCurves empty_curves(const StageData& data, std::span<const candidates::Candidate> candidates);

// First look: adds one point near the present value of each of `chosen`, of numbers of the description at an ordinary
// error; for one-sided ones also the end of the range, for two-sided effects a point on the other side. If the curve,
// extrapolated to an end of the range, stays shorter than the gap, adds that end, too: a servo's torque may suffice
// down to half of it. Numbers whose curve does not stay shorter get a point a quarter of the way instead.
void add_first_look(EffectCurves& curves, const StageData& data, std::span<const std::size_t> chosen,
                    const Simulate& simulate);
// Simulates points spread over the range of each of `chosen`, denser near the present value, where it has none.
void add_spread(EffectCurves& curves, const StageData& data, std::span<const std::size_t> chosen,
                const Simulate& simulate);
// Bisects, up to four times, curves that shift little up to a value and much beyond it (drives that stall), where they
// become as long as the gap: a line between distant points would hide the bend. Curves that have shifted nearly all by
// their innermost point get points nearer to neutral, up to four, each at a quarter of the way to the previous one.
void follow_bends(EffectCurves& curves, const StageData& data, std::span<const std::size_t> chosen,
                  const Simulate& simulate);

// Reduces all curves except `kept` to their present points, so that no search finds them.
void forget_all_but(EffectCurves& curves, std::span<const std::size_t> kept);

// Whether a curve shifts little up to one of its points and is longer than `length` at the next, so that its course in
// between is unknown (commands below a dead band).
bool is_bent(const EffectCurves& curves, const StageData& data, std::size_t candidate, double length);

// Simulates points and adds them. Replaces existing points at the same values.
void add_points(EffectCurves& curves, const StageData& data, std::span<const Setting> points, Fidelity fidelity,
                const Simulate& simulate);
// The same with known shifts of each point.
void insert_points(EffectCurves& curves, const StageData& data, std::span<const Setting> points,
                   const std::vector<GroupVectors>& shifts, Fidelity fidelity);

// Length of a difference in units of noise: sqrt(sum over bins of difference^2 / variance); and its square.
double squares_in_noise(const StageData& data, const GroupVectors& difference);
double length_in_noise(const StageData& data, const GroupVectors& difference);
// Of each kind of channels (kind_of()).
std::vector<double> squares_of_kinds(const StageData& data, const GroupVectors& difference);
// Whether an effect acts in a kind of channels: no small part of its shift's squares, squares_of_kinds(), is there.
// What else happens in the others says nothing of it.
bool acts_in(std::span<const double> squares_of_shift, std::size_t kind);
// Likewise for the residual of the nominal robot.
double gap_in_noise(const StageData& data);

}  // namespace kenaf::gap::diagnose
