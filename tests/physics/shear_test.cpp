// Friction that builds up with shear displacement (Janosi and Hanamoto 1961). References are integrals over the contact
// length of a track that presses evenly: the drawbar pull of Wong, Theory of Ground Vehicles, 2.4,
//   F = mu W [1 - K / (i L) (1 - exp(-i L / K))],
// and the balance of friction's moment in a turn on the spot. The centre of mass lies at the ground's height, so that
// the load stays even however much is pulled.
#include <catch2/catch.hpp>
#include <functional>

#include "physics/dynamics/belt_ground.hpp"
#include "physics/dynamics/shear.hpp"
#include "physics/terrain_effects.hpp"
#include "tests/physics/scenes.hpp"

using namespace kenaf;
using namespace kenaf::physics;

namespace {

constexpr double kMu = 0.8, kBelt_mps = 0.2;

// Without flippers; strong motors hold the belts at their speed.
RobotDescription even_tracks(double K_m) {
  RobotDescription robot = plain_tracks(kMu);
  const TrackDescription& track = robot.track.front();
  robot.body.p_BBcm_m = {track.p_BT_m.x(), 0, track.p_BT_m.z() - track.end_radius_m};
  robot.track.front().shear_deformation_m = K_m;
  robot.drive.max_force_n = 1000;
  return robot;
}

// [1 - K / (i L) (1 - exp(-i L / K))]
double built_up(double slip, double length_m, double K_m) {
  const double shear = slip * length_m / K_m;
  return 1 - (1 - std::exp(-shear)) / shear;
}

double where_zero(double low, double high, const std::function<double(double)>& rising) {
  for (int i = 0; i < 60; ++i) (rising((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
  return low;
}

// The slip at which the pull up a slope is weight times tan of it.
double slip_by_closed_form(double tan_slope, double length_m, double K_m) {
  return where_zero(1e-9, 1, [&](double i) { return kMu * built_up(i, length_m, K_m) - tan_slope; });
}

// 1 - speed / belt speed, of a robot that drives up a slope of `ground`, or down where it is negative.
double slip_on(const RobotDescription& robot, const WorldDescription& flat, double tan_slope,
               double belt_mps = kBelt_mps, PhysicsSettings settings = {}) {
  World world(with_terrain_effects(flat, {.ground_slope_rad = -std::atan(tan_slope)}), settings, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(belt_mps, belt_mps));
  run(world, 1);
  const double before = world.truth(id).X_WB.p.x();
  run(world, 1);
  return 1 - (world.truth(id).X_WB.p.x() - before) / belt_mps;
}

double turn_on_the_spot_radps(const RobotDescription& robot, double belt_mps = kBelt_mps) {
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(-belt_mps, belt_mps));
  run(world, 1);
  const double before = yaw_of(world.truth(id).X_WB);
  run(world, 1);
  return std::remainder(yaw_of(world.truth(id).X_WB) - before, 2 * std::numbers::pi);
}

}  // namespace

TEST_CASE("Shear: a stretch holds the mean of 1 - exp(-j / K) over its length") {
  // From the entry on, with i L / K = 1: 1 - (1 - 1/e) = 1/e. With 2: 1 - (1 - 1/e²) / 2 = 0.567668.
  const double rate = 1 / (0.01 * kBelt_mps);  // K = 10 mm
  const auto share_per_slip = [&](double from_m, double to_m, double slip_mps) {
    return sheared_share_per_slip({rate * from_m, rate * to_m}, slip_mps);
  };
  const auto share = [&](double from_m, double to_m, double slip_mps) {
    return slip_mps * share_per_slip(from_m, to_m, slip_mps);
  };
  CHECK(share(0, 0.1, 0.1 * kBelt_mps) == Approx(std::exp(-1)).epsilon(1e-12));
  CHECK(share(0, 0.1, 0.2 * kBelt_mps) == Approx(0.5676676416183064).epsilon(1e-12));
  // Two halves of a stretch have the whole's mean.
  CHECK((share(0, 0.05, 0.03) + share(0.05, 0.1, 0.03)) / 2 == Approx(share(0, 0.1, 0.03)).epsilon(1e-12));
  // Little slip: j / K in the middle. Much slip: all of it.
  CHECK(share_per_slip(0.02, 0.04, 0) == Approx(0.03 * rate).epsilon(1e-12));
  CHECK(share_per_slip(0.02, 0.04, 1e-9) == Approx(0.03 * rate).epsilon(1e-6));
  CHECK(share(0.02, 0.04, 10) == Approx(1).epsilon(1e-12));
}

TEST_CASE("Shear: a contact point stands for half a piece on both sides, from where the belt enters the ground") {
  const BeltShape belt{
      .radius = {0.1, 0.1}, .length = 0.4, .half_width = 0.05, .p_BodyT = {0, 0, 0}, .pieces = 4, .surface = {}};
  const auto stretch = [&](int place, PressedRun pressed, bool forward) {
    const BeltTouch touch{.p_T = {},
                          .normal_T = {0, 0, 1},
                          .gap_m = 0,
                          .weight = 1,
                          .holds_lugs = false,
                          .run_place = place,
                          .feature = 0};
    const ShearStretch s = stretch_of(belt, touch, {1, forward, pressed, {}});
    return std::array{s.from, s.to};
  };
  using Stretch = std::array<double, 2>;
  const auto near = [](Stretch a, Stretch b) { return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) < 1e-12; };
  // Forward the lower run enters at disc 1, the place 4; pieces are 0.1 m long.
  CHECK(near(stretch(4, {0, 4}, true), {0, 0.05}));
  CHECK(near(stretch(3, {0, 4}, true), {0.05, 0.15}));
  CHECK(near(stretch(0, {0, 4}, true), {0.35, 0.4}));
  CHECK(near(stretch(0, {0, 4}, false), {0, 0.05}));
  // In the air ahead of place 2: it enters there.
  CHECK(near(stretch(1, {0, 2}, true), {0.05, 0.15}));
  CHECK(near(stretch(3, {0, 2}, true), {0, 0}));
  // One place alone, or none of a run: no length.
  CHECK(near(stretch(0, {0, 0}, true), {0, 0}));
  CHECK(near(stretch(-1, {0, 4}, true), {0, 0}));
}

TEST_CASE("Shear: the drawbar pull grows with slip as the closed form says") {
  const double L = even_tracks(0).contact_length_m();
  for (const double K : {0.005, 0.02, 0.05}) {
    for (const double share : {0.2, 0.5, 0.8}) {
      const double expected = slip_by_closed_form(share * kMu, L, K);
      if (expected > 0.9) continue;
      const double slip = slip_on(even_tracks(K), ground(), share * kMu);
      INFO("K " << K << ", " << share << " of the steepest slope: slip " << slip << ", expected " << expected);
      CHECK(slip == Approx(expected).epsilon(0.01));
    }
  }
}

TEST_CASE("Shear: slip is the same at any belt speed, on boxes, and in reverse, where it brakes") {
  const RobotDescription robot = even_tracks(0.02);
  const double L = robot.contact_length_m(), expected = slip_by_closed_form(0.4, L, 0.02);
  for (const double u : {0.02, 0.4}) CHECK(slip_on(robot, ground(), 0.4, u) == Approx(expected).epsilon(0.01));
  CHECK(slip_on(robot, ground(), -0.4, -kBelt_mps) == Approx(expected).epsilon(0.01));
  CHECK(slip_on(robot, ground(), -0.4) == Approx(-expected).epsilon(0.01));
  WorldDescription boxes;
  boxes.start_poses.push_back({"start", {}});
  boxes.boxes.push_back(fixed_box({4, 4, 1}, {0, 0, -0.5}));
  CHECK(slip_on(robot, boxes, 0.4) == Approx(expected).epsilon(0.01));
}

TEST_CASE("Shear: as K vanishes, friction becomes Coulomb's") {
  CHECK(std::abs(slip_on(even_tracks(1e-6), ground(), 0.9 * kMu)) < 1e-3);
  CHECK(slip_on(even_tracks(1e-6), ground(), 1.1 * kMu) > 1);
  const double coulomb = turn_on_the_spot_radps(even_tracks(0));
  CHECK(turn_on_the_spot_radps(even_tracks(1e-6)) == Approx(coulomb).epsilon(1e-3));
}

TEST_CASE("Shear: a robot that stands, or comes to a stop, holds a slope without creeping") {
  for (const double K : {1e-4, 0.02, 0.1}) {
    World world(with_terrain_effects(ground(), {.ground_slope_rad = std::atan(0.95 * kMu)}), {}, 1);
    const RobotId id = world.add_robot(even_tracks(K), "a", {});
    run(world, 0.5);
    const double standing_m = world.truth(id).X_WB.p.x();
    run(world, 5);
    CHECK(std::abs(world.truth(id).X_WB.p.x() - standing_m) < 1e-4);
    world.set_command(id, drive(0.2, 0.2));
    run(world, 0.5);
    world.set_command(id, drive(0, 0));
    run(world, 2);
    const double stopped_m = world.truth(id).X_WB.p.x();
    run(world, 5);
    INFO("K " << K << ": crept " << world.truth(id).X_WB.p.x() - stopped_m);
    CHECK(std::abs(world.truth(id).X_WB.p.x() - stopped_m) < 1e-4);
  }
}

// At (x, y) of a track of speed u the ground is slipped over by (u - w y, w x); the right track enters at its front
// end, x = L/2, the left one, which runs backwards, at its rear end: a half turn about the middle, so that one side's
// moment is half of the whole. The sum is over the points that a belt stands on, each with the mean over its stretch.
TEST_CASE("Shear: a turn on the spot is that of the balance of moments, slower than with Coulomb's friction") {
  for (const double K : {0.002, 0.01, 0.05}) {
    const RobotDescription robot = even_tracks(K);
    const TrackDescription& track = robot.track.front();
    const double L = track.straight_m(), n = track.pieces;
    const auto braking = [&](double w) {
      double sum = 0;
      for (const double side : {-0.5, 0.5}) {
        for (int i = 0; i <= track.pieces; ++i) {
          const double x = L * (i / n - 0.5), y = track.p_BT_m.y() + side * track.width_m;
          const double slip_x = kBelt_mps - w * y, slip_y = w * x, slip = std::hypot(slip_x, slip_y);
          const double a = slip / (kBelt_mps * K) * L * std::max(n - i - 0.5, 0.0) / n;
          const double b = slip / (kBelt_mps * K) * L * std::min(n - i + 0.5, n) / n;
          const double share = 1 - (std::exp(-a) - std::exp(-b)) / (b - a);
          sum -= (i == 0 || i == track.pieces ? 0.5 : 1) * share * (y * slip_x - x * slip_y) / slip;
        }
      }
      return sum;
    };
    const double expected = where_zero(0.01, kBelt_mps / track.p_BT_m.y(), braking);
    const double turned = turn_on_the_spot_radps(robot);
    INFO("K " << K << ": " << turned << " rad/s, expected " << expected);
    CHECK(turned == Approx(expected).epsilon(2e-3));
  }
  CHECK(turn_on_the_spot_radps(even_tracks(0.01)) != Approx(turn_on_the_spot_radps(even_tracks(0))).epsilon(0.01));
}

TEST_CASE("Shear: however steep, it lets no speed oscillate, at long time steps too") {
  for (const double time_step_s : {0.001, 0.004}) {
    World world(with_terrain_effects(ground(), {.ground_slope_rad = -std::atan(0.5 * kMu)}),
                {.time_step_s = time_step_s}, 1);
    RobotDescription robot = even_tracks(1e-3);
    robot.drive.max_force_n = 300;  // of more, the motor's own line oscillates at 4 ms
    const RobotId id = world.add_robot(robot, "a", {});
    world.set_command(id, drive(0.02, 0.02));
    run(world, 1);
    double low = 1, high = -1;
    for (int i = 0; i < 200; ++i) {
      world.step();
      const double v = world.truth(id).v_WB_mps.x();
      low = std::min(low, v), high = std::max(high, v);
    }
    CHECK(high - low < 1e-5);
  }
}

TEST_CASE("Shear: wheels have no known length of contact, and all of their friction") {
  const auto driven = [](double K_m) {
    RobotDescription robot = load_robot("husky");
    robot.effects.shear_deformation_m = K_m;
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(robot, "a", {});
    world.set_command(id, drive(0.1, 0.3));
    run(world, 1);
    return world.truth(id).X_WB;
  };
  CHECK(driven(0.05).p == driven(0).p);
  CHECK(driven(0.05).q.coeffs() == driven(0).q.coeffs());
}
