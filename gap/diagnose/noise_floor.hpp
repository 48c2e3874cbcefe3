// What a difference between robot and simulation may be without being a gap: measurement noise and the spread of
// repeats, taken from the data, and what the simulation itself leaves open (where exactly the robot stood at the start,
// and numbers of the simulator that no robot has).
//
// The floor of a run is a Gaussian: independent noise of each bin, and a few shapes in time, each with an unknown
// amount of standard deviation 1. docs/gap-method.md has the derivation.
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

// Turns differences of one run into numbers that are independent with standard deviation 1 where there is no gap.
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

// What the simulation leaves open in one run. A variation by +1 and by -1 sigma shifts the prediction by a shape, up to
// sign, as long as all is smooth. What of it is not up to sign (a fall that begins earlier either way, a landing that
// has two ways to go on) is a shape too; but there is no knowing where it falls next time, so it counts as noise of
// those bins as well.
struct OpenShapes {
  Eigen::MatrixXd local;  // in columns, each with an unknown amount of its own in each run: start pose, sensors' counts
  Eigen::MatrixXd numerics;   // in columns, the same unknown amount in all runs: the simulator's numbers
  Eigen::VectorXd roughness;  // of each bin, 1 sigma
};

struct NoiseFloor {
  std::vector<double> sigma;  // of a full bin of each channel, all of what is independent; 0: never measured. In the
                              // middle one of all manoeuvres: where repeats differ by more, their bins have more
  std::vector<Eigen::VectorXd> sigma_of_bin;  // of each run, noise and roughness together
  std::vector<Whitener> whiteners;            // of each run
  bool from_repeats = false;       // otherwise as stated, or from the residuals alone, which a gap makes larger
  std::vector<OpenShapes> open{};  // of each run
  std::vector<Eigen::VectorXd> noise_of_bin{};  // of each run: sigma_of_bin without roughness
  // Of each group of stage_data() (number_shapes.hpp), no part of the floor of a run; empty: none.
  std::vector<Eigen::MatrixXd> number_shapes{};

  // Of all bins of all runs that are not empty, whitened: 1 is the floor, whatever its shapes.
  double rms(const std::vector<Eigen::VectorXd>& differences) const;
};

// Of the start pose, where the log has no rows at rest to average, 1 sigma (chosen: as good as motion capture).
inline constexpr double kOpenStart_m = 0.001, kOpenStart_rad = 0.002;

// Start pose by its uncertainty (`start_sigma_m`, `start_sigma_rad`); time step, solver iterations, contact stiffness
// and damping by a factor of 2 either way; and for each channel an offset of its resolution: a count more or less lasts
// as long as the robot rolls on. Around `model`: where an event falls is open around where that model has it. Repeats
// have the shapes of one of them.
std::vector<OpenShapes> open_shapes(const std::vector<StageFeatures>& features, Predictor& predictor, Passage passage,
                                    const Variation& model, double start_sigma_m, double start_sigma_rad);

// `residuals`: measured minus nominal, of each run. `stated`: for each of diagnosis_channels() the noise of one sample,
// 1 sigma, as somebody knows it, 0 where nobody does; empty: of none. It stands in for the residuals, where no run
// repeats another.
NoiseFloor noise_floor(const std::vector<StageFeatures>& features, const std::vector<Eigen::VectorXd>& residuals,
                       const std::vector<std::vector<std::size_t>>& repeats, const std::vector<OpenShapes>& open,
                       std::span<const double> stated = {});

// The rms of what repeats differ by, whitened, over the bins that more than one of them has; 1 without repeats.
double rms_of_repeats(const NoiseFloor& floor, const std::vector<StageFeatures>& features,
                      const std::vector<Eigen::VectorXd>& deviations,
                      const std::vector<std::vector<std::size_t>>& repeats);

// The same noise with open shapes of another model: bins are as rough as the rougher one of the two has them.
NoiseFloor with_open_shapes(const NoiseFloor& floor, const std::vector<OpenShapes>& open);

}  // namespace kenaf::gap::diagnose
