// What each effect would do to the observed runs, along its range: a curve through whitened space, known at some values and
// straight between them. All fits, held-out scores and resamplings are made on these curves, without further roll-outs.
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gap/diagnose/noise_floor.hpp"
#include "gap/diagnose/prediction.hpp"
#include "physics/effects.hpp"

namespace kenaf::gap {

struct CurvePoint {
  double value;     // of the parameter
  int column;       // of EffectCurves::shifts; -1: the present value, which shifts nothing
  bool exact;       // every run was simulated, not only one of each group of repeats
};

struct EffectCurve {
  const physics::EffectInfo* effect;
  const physics::EffectParameter* parameter;
  std::vector<CurvePoint> points;  // by value
  // The largest length of the curve, in floors: below 1 these runs do not show the effect at any size.
  double visible = 0;
};

// The value that the robot's description has already, which shifts nothing: neutral, unless the effect is switched on there.
double present_value(const EffectCurve& curve);

struct EffectCurves {
  std::vector<EffectCurve> curves;
  std::vector<Eigen::VectorXd> residual;    // measured minus nominal, of each run
  std::vector<Eigen::MatrixXd> raw_shifts;  // varied minus nominal, of each run; one column for each point
  std::vector<Whitener> whiteners;          // of each run
  // the same, whitened
  std::vector<Eigen::VectorXd> gap;
  std::vector<Eigen::MatrixXd> shifts;
};

using Whitened = std::vector<Eigen::VectorXd>;  // of each run
double squared_length(const Whitened& runs);

// With other whiteners, all that is whitened is made anew.
void set_whiteners(EffectCurves& curves, std::vector<Whitener> whiteners);

// The parameters that can be fitted to these runs: those of the catalogue but `without`, of a robot with flippers or
// without, in a world with obstacles or without. What is random (command_loss) is not among them.
std::vector<EffectCurve> candidate_curves(const Observations& observations, std::span<const std::string> without);

// Simulates points spread over each candidate's range, denser near neutral, and follows bends; coarse.
EffectCurves scan_effects(std::vector<EffectCurve> candidates, const std::vector<Eigen::VectorXd>& residuals,
                          const NoiseFloor& floor, Predictor& predictor);

// Adds points to curves. One that is there at the same value is replaced.
struct NewPoint {
  std::size_t curve;
  double value;
};
void add_points(EffectCurves& curves, std::span<const NewPoint> points, Fidelity fidelity, Predictor& predictor);

// The same where the shifts of each point are known already.
void insert_points(EffectCurves& curves, std::span<const NewPoint> points, const std::vector<Shift>& shifts,
                   Fidelity fidelity);

// A curve that moves little up to a value and much beyond it (drives that stall) is halved, up to four times, where it
// becomes as long as the gap: between points that are far apart a straight line hides where it goes. One that has done nearly all
// by its innermost point (drives that stall before it) gets points nearer to neutral, up to four, each a quarter of the way to
// the one before. `simulate` adds points to these curves.
void follow_bends(EffectCurves& curves, const std::function<void(std::span<const NewPoint>)>& simulate);

// Effects at their values, on top of the nominal ones.
Variation varied(const EffectCurves& curves, std::span<const NewPoint> effects, const Predictor& predictor);

}  // namespace kenaf::gap
