// Differences between robot and simulation that are no gap: measurement noise and the spread of repeats, estimated from
// the data, and open details of the simulation (the exact start pose, and numbers of the simulator without a physical
// counterpart).
//
// The floor of a run is a Gaussian: independent noise of each bin, and a few shapes. A shape is the course, over all
// bins of a run, by which one unknown at 1 sigma shifts the measurements; its amount is unknown, with mean 0 and
// standard deviation 1. *Open* shapes are those of the start, the sensors and the simulator's numbers; *number* shapes
// (number_shapes.hpp) are those of errors of the description. *Local* shapes have another amount in each manoeuvre,
// *shared* ones the same in all. docs/gap-method.md has the derivation.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/observation.hpp"
#include "gap/diagnose/prediction.hpp"
#include "gap/diagnose/repeats.hpp"
#include "gap/diagnose/stage_features.hpp"

namespace kenaf::gap::diagnose {

// Transforms differences of one run into independent numbers with standard deviation 1 if there is no gap.
class Whitener {
 public:
  Whitener() = default;
  // `sigma`: of each bin. `shapes`: one column each.
  Whitener(const Eigen::VectorXd& sigma, const Eigen::MatrixXd& shapes);
  Eigen::VectorXd operator()(const Eigen::VectorXd& difference) const;

 private:
  Eigen::VectorXd inverse_sigma_;
  Eigen::MatrixXd directions_;  // orthonormal, in units of sigma
  Eigen::VectorXd shrink_;
};

// Open details of the simulation in one run. Variations by +1 and -1 sigma shift the prediction by a shape and its
// negative if all is smooth (odd part). The even part (a fall that begins earlier either way, a landing that may
// continue in two ways) is a shape too; as it may occur elsewhere next time, it also counts as noise of those bins.
struct OpenShapes {
  // In columns, each with a separate unknown amount in each run: start pose (kShapesOfStart), sensors' counts and
  // clocks, forces held while the robot stands.
  Eigen::MatrixXd local;
  Eigen::MatrixXd numerics;   // in columns, the same unknown amount in all runs: the simulator's numbers
  Eigen::VectorXd roughness;  // of each bin, 1 sigma
  // Like `local`, whatever the model: other ways on from other start poses (baseline.hpp); no columns without a
  // baseline.
  Eigen::MatrixXd ways{};
};

// Local shapes and ways, side by side.
Eigen::MatrixXd shapes_of_run(const OpenShapes& open);

inline constexpr Eigen::Index kShapesOfStart = 6;  // odd and even parts of x, y and yaw, the first of OpenShapes::local

struct NoiseFloor {
  std::vector<double> sigma;  // all independent noise of a full bin of each channel; 0: never measured. For the median
                              // manoeuvre: bins of groups with a larger spread have more
  std::vector<Eigen::VectorXd> sigma_of_bin;    // for each run, noise and roughness together
  std::vector<Whitener> whiteners;              // of each run
  bool from_repeats = false;                    // otherwise as stated, or from the residuals, which a gap inflates
  std::vector<OpenShapes> open{};               // of each run
  std::vector<Eigen::VectorXd> noise_of_bin{};  // for each run: sigma_of_bin without roughness
  // For each group of stage_data() (number_shapes.hpp), not part of a run's floor; empty: none.
  std::vector<Eigen::MatrixXd> number_shapes{};

  // Whitened rms over all bins of all non-empty runs: 1 is the floor, whatever its shapes.
  double rms(const std::vector<Eigen::VectorXd>& differences) const;
};

// Uncertainty of the start pose, 1 sigma, if the log has no rows at rest to average (chosen: as good as motion
// capture).
inline constexpr double kOpenStart_m = 0.001, kOpenStart_rad = 0.002;

// Varies the start pose by its uncertainty (`start_sigma_m`, `start_sigma_rad`); time step, solver iterations, contact
// stiffness and damping by a factor of 2 either way; and each channel by an offset of its resolution, as one count
// persists while the robot rolls on. Adds the forces that a standing robot holds (held_forces.hpp). Varies around
// `model`, as events occur at its times. Repeats share the shapes of one of them.
std::vector<OpenShapes> open_shapes(const std::vector<StageFeatures>& features, Predictor& predictor, Passage passage,
                                    const Variation& model, double start_sigma_m, double start_sigma_rad);

// `residuals`: measured minus nominal, for each run. `stated`: for each of diagnosis_channels() the known noise of one
// sample, 1 sigma, 0 if unknown; empty: all unknown. Used instead of the residuals if no run repeats another.
NoiseFloor noise_floor(const std::vector<StageFeatures>& features, const std::vector<Eigen::VectorXd>& residuals,
                       const std::vector<std::vector<std::size_t>>& repeats, const std::vector<OpenShapes>& open,
                       std::span<const double> stated = {});

// Standard deviations of sums of independent errors with standard deviations `a` and `b`, element by element.
Eigen::VectorXd root_of_squares(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

// Whitened rms of the deviations between repeats, over bins that at least two of them have; 1 without repeats.
double rms_of_repeats(const NoiseFloor& floor, const Deviations& deviations);

// The same noise and ways with the open shapes of another model; roughness is the larger one of both.
NoiseFloor with_open_shapes(const NoiseFloor& floor, const std::vector<OpenShapes>& open);

}  // namespace kenaf::gap::diagnose
