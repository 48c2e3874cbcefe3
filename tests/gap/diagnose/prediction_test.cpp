// What is asked of the simulator, and how often it simulates.
#include "gap/diagnose/prediction.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "gap/diagnose/repeats.hpp"
#include "tests/formats/runs/temporary_folder.hpp"
#include "tests/gap/made_run.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;

namespace {

// A robot that is commanded to turn on the spot, whose tracks, heading and turn rate are measured.
class TurningRobot {
 public:
  TurningRobot() {
    const auto right = [](double t_s) { return t_s < 0.5 ? 0 : 0.1; };
    const auto left = [](double t_s) { return t_s < 0.5 ? 0 : -0.1; };
    const auto yaw = [](double t_s) { return t_s < 0.5 ? 0 : 0.3 * (t_s - 0.5); };
    const auto rate = [](double t_s) { return t_s < 0.5 ? 0 : 0.3; };
    const auto zero = [](double) { return 0.0; };
    runs::write_run(folder_ / "a.csv", test::made_run(2, 0.05,
                                                      {{"cmd_track_left_mps", left},
                                                       {"cmd_track_right_mps", right},
                                                       {"track_left_mps", left},
                                                       {"track_right_mps", right},
                                                       {"x_m", zero},
                                                       {"y_m", zero},
                                                       {"yaw_rad", yaw},
                                                       {"gyro_z_radps", rate}}));
    test::write_file(folder_ / "dataset.toml",
                     "format = \"kenaf-runs/1\"\nsource = \"real\"\nrobot = \"kenaf\"\nworld = \"flat\"\n"
                     "[[run]]\nfile = \"a.csv\"\n");
    observations = observe(folder_.path(), "", "", 10);
    features = compared_features(observations, 0.25);
  }
  Predictor predictor() const {
    Predictor predictor(observations, features, repeats_of(observations), 1);
    predictor.simulate_nominal();
    return predictor;
  }
  Variation with_friction_across(double scale) const {
    Variation variation{observations.robot, {}};
    variation.robot.effects.friction_across_scale = scale;
    return variation;
  }

  Observations observations;
  ComparedFeatures features;

 private:
  test::TemporaryFolder folder_;
};

}  // namespace

TEST_CASE("A run is simulated once for all stages that are compared in the same replay") {
  const TurningRobot robot;
  Predictor predictor = robot.predictor();
  CHECK(predictor.roll_outs() == 2);  // its commands replayed, and its belts
  const std::vector<Variation> slippery{robot.with_friction_across(0.5)};
  const Shift of_body = predictor.shifts(slippery, Passage::drive_to_body, Fidelity::every_run)[0];
  CHECK(predictor.roll_outs() == 3);
  const Shift of_sensor = predictor.shifts(slippery, Passage::body_to_sensor, Fidelity::every_run)[0];
  CHECK(predictor.roll_outs() == 3);
  CHECK(of_body[0].norm() > 0.01);

  // the same bits as where nothing was known before
  Predictor another = robot.predictor();
  CHECK(another.shifts(slippery, Passage::body_to_sensor, Fidelity::every_run)[0][0] == of_sensor[0]);
}

TEST_CASE("What differs in its sensors alone and is asked for together has the bits of a simulation of its own") {
  const TurningRobot robot;
  Predictor predictor = robot.predictor();
  std::vector<Variation> all(4, predictor.unvaried());
  all[0].robot.effects.gyro_scale = 1.05;
  all[1].robot.effects.tracking_delay_s = 0.1;
  all[2].robot.effects.friction_across_scale = 0.5;
  all[3].robot.effects.friction_across_scale = 0.5;
  all[3].robot.effects.gyro_bias_z_radps = 0.02;
  for (const Passage passage : {Passage::drive_to_body, Passage::body_to_sensor}) {
    const std::vector<Shift> together = robot.predictor().shifts(all, passage, Fidelity::every_run);
    for (std::size_t v = 0; v < all.size(); ++v) {
      Predictor alone = robot.predictor();
      CHECK(alone.shifts({&all[v], 1}, passage, Fidelity::every_run)[0][0] == together[v][0]);
    }
  }
}

TEST_CASE("What differs in anything is simulated anew, and what is asked for twice at once is simulated once") {
  const TurningRobot robot;
  Predictor predictor = robot.predictor();
  const Variation nominal = predictor.unvaried();
  Variation sideways = nominal, late = nominal, stiff = nominal, biased = nominal;
  sideways.start_y_m = 0.001;
  late.samples_late = 1;
  stiff.physics.contact_stiffness_npm *= 2;
  biased.robot.sensors.front().bias_radps += 0.01;
  const std::vector<Variation> all{nominal, sideways, late, stiff, biased, sideways};
  const std::vector<Shift> shifts = predictor.shifts(all, Passage::drive_to_body, Fidelity::fine);
  CHECK(predictor.roll_outs() == 2 + 4);
  CHECK(shifts[0][0].isZero(0));
  CHECK(shifts[1][0] == shifts[5][0]);
  CHECK(shifts[1][0] != shifts[2][0]);
  // twice the time step is another simulation, of the nominal robot, too
  predictor.shifts({all.data() + 1, 1}, Passage::drive_to_body, Fidelity::coarse);
  CHECK(predictor.roll_outs() == 2 + 4 + 2);
}
