// The data of a challenge's cases: what is hidden is as large as asked, and is not to be read anywhere.
#include "gap/challenge/make_case.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>

#include "formats/runs/dataset.hpp"
#include "gap/candidates/candidate.hpp"
#include "gap/candidates/robot_numbers.hpp"
#include "gap/challenge/case_runs.hpp"
#include "gap/challenge/look_alike.hpp"
#include "gap/challenge/sealed_data.hpp"
#include "gap/challenge/sha256.hpp"
#include "gap/challenge/shrinks.hpp"
#include "gap/challenge/true_shares.hpp"
#include "gap/diagnose/prediction.hpp"
#include "tests/formats/runs/temporary_folder.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using namespace kenaf::gap::challenge;
using namespace kenaf::gap::diagnose;
using test::TemporaryFolder;

namespace {

std::filesystem::path robot_without_gap(const std::string& manoeuvre, const std::filesystem::path& folder) {
  CasePlan plan;
  plan.name = "case-000";
  plan.manoeuvres = {manoeuvre};
  plan.unseen = "arc";
  plan.seed = 3;
  make_case(plan, folder, 1);
  return folder;
}

}  // namespace

TEST_CASE("A case that is being made ends when it is asked to") {
  const TemporaryFolder folder;
  CasePlan plan;
  plan.manoeuvres = {"straight"};
  plan.unseen = "arc";
  const std::atomic<bool> stop = true;
  CHECK_THROWS_AS(make_case(plan, folder / "none", 1, &stop), Stopped);
  plan.stratum = Stratum::single;
  plan.effects = {{"encoder_scale", "scale", 4, 0}};
  CHECK_THROWS_AS(make_case(plan, folder / "single", 1, &stop), Stopped);
}

TEST_CASE("Data of a sealed challenge that are gone or changed are made again, the same ones") {
  const TemporaryFolder folder;
  SealedCase sealed;
  sealed.plan.name = "case-000";
  sealed.plan.manoeuvres = {"straight"};
  sealed.plan.unseen = "arc";
  sealed.plan.seed = 3;
  const std::filesystem::path data = case_folder(folder.path(), "case-000");
  make_case(sealed.plan, data, 1);
  sealed.data_sha256 = sha256_of_dataset(data);
  const std::string run = test::read_file(data / "run-001.csv");
  std::size_t made = 0;
  const auto make_missing = [&] {
    made = 0;
    make_missing_data(folder.path(), {3, {sealed}}, 1, nullptr,
                      [&](std::size_t so_far, std::size_t) { made = so_far; });
  };
  make_missing();
  CHECK(made == 0);
  std::filesystem::remove_all(data);
  CHECK_FALSE(is_sealed_dataset(case_folder(folder.path(), sealed.plan.name), sealed));
  make_missing();
  CHECK(made == 1);
  CHECK(test::read_file(data / "run-001.csv") == run);
  test::write_file(data / "run-001.csv", "t_s,x_m\n0,0\n1,2\n");
  make_missing();
  CHECK(made == 1);
  CHECK(is_sealed_dataset(case_folder(folder.path(), sealed.plan.name), sealed));

  sealed.data_sha256 = "of another program";
  CHECK_THROWS_WITH(make_missing(), Catch::Contains("does not match the sealed data"));
  CHECK(test::read_file(data / "run-001.csv") == run);  // nothing is replaced by what is not right
  CHECK_FALSE(std::filesystem::exists(data.string() + ".part"));
}

TEST_CASE(
    "A baseline has runs of before: the same robot and commands, noise of their own, and sealed as the others are") {
  const TemporaryFolder folder;
  SealedCase sealed;
  CasePlan& plan = sealed.plan;
  plan.name = "case-000";
  plan.stratum = Stratum::baseline;
  plan.manoeuvres = {"straight"};
  plan.longest_s = {2};
  plan.unseen = "arc";
  plan.repeats = 1;
  plan.seed = 3;
  plan.background.numbers = {{"track.separation_m", 0.203}};
  const std::filesystem::path data = case_folder(folder.path(), "case-000"), before = data / kBeforeFolder;
  make_case(plan, data, 1);
  CHECK(plan.background.floors > 0);
  const runs::Run now_run = runs::read_run(data / "run-000.csv"), before_run = runs::read_run(before / "run-000.csv");
  CHECK(now_run.columns == before_run.columns);
  CHECK(now_run.row_count() == before_run.row_count());
  CHECK(std::ranges::equal(now_run.column("cmd_track_left_mps"), before_run.column("cmd_track_left_mps")));
  CHECK_FALSE(std::ranges::equal(now_run.column("x_m"), before_run.column("x_m")));

  sealed.data_sha256 = sha256_of_dataset(data);
  CHECK(is_sealed_dataset(data, sealed));
  const std::string run = test::read_file(before / "run-000.csv");
  test::write_file(before / "run-000.csv", "t_s,x_m\n0,0\n1,2\n");
  CHECK_FALSE(is_sealed_dataset(data, sealed));
  std::filesystem::remove_all(before);
  CHECK_FALSE(is_sealed_dataset(data, sealed));
  make_missing_data(folder.path(), {3, {sealed}, ChallengeKind::imperfect}, 1, nullptr,
                    [](std::size_t, std::size_t) {});
  CHECK(test::read_file(before / "run-000.csv") == run);
}

TEST_CASE("A case is made: its effect is as large as asked, and its folder does not say which it is", "[long]") {
  const TemporaryFolder folder;
  CasePlan plan;
  plan.name = "case-007";
  plan.stratum = Stratum::single;
  plan.effects = {{"encoder_scale", "scale", 4, 0}};
  plan.manoeuvres = {"straight-fast"};
  plan.unseen = "arc";
  plan.physics.time_step_s /= 2;
  plan.seed = 3;
  make_case(plan, folder / "case", 1);
  const HiddenEffect& hidden = plan.effects.front();
  CHECK(plan.manoeuvres == std::vector<std::string>{"straight-fast"});
  CHECK(hidden.value != 1);
  CHECK(hidden.floors == Approx(4).epsilon(0.06));  // made at most a twentieth larger

  // Gap and floor are independent, so that their squares add: before^2 = floor^2 + (size floor)^2. Start pose and noise
  // are others than those by which the size was made.
  ComparedRuns runs(folder / "case", 1);
  const physics::RobotDescription truth = hidden_robot_in_model(plan);
  Variation model = runs.predictor.unvaried();
  model.robot = truth;
  const Floors floors = floors_around(runs, model);
  const Differences left = runs.residuals - shifts_of(runs, truth, Fidelity::every_run);
  const double ratio = rms(floors, runs.residuals) / rms_of_repeats(runs, floors, left);
  CHECK(std::sqrt(ratio * ratio - 1) == Approx(4).epsilon(0.2));

  // an encoder's scale is seen in the drives, and the truth explains all of it there; the nominal robot explains
  // nothing
  const Shrinks drives = shrinks_on(folder / "case", physics::load_robot(kChallengedRobot), truth, 1).of_stage[0];
  CHECK(drives.before > 4 * drives.floor);
  CHECK(drives.report == Approx(0).margin(1e-9));
  CHECK(drives.hidden > 0.9);

  const runs::Dataset dataset = runs::read_dataset(folder / "case");
  CHECK(dataset.source == "real");
  CHECK(dataset.runs.size() == 2);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "case")) {
    CHECK(entry.path().string().find("encoder") == std::string::npos);
    const std::string bytes = test::read_file(entry.path());
    CHECK(bytes.find("encoder") == std::string::npos);
    CHECK(bytes.find("single") == std::string::npos);
    CHECK(bytes.find("challenge") == std::string::npos);
  }
}

TEST_CASE("Imperfect: an effect is as many times as large as the background as asked, and its share is by squares",
          "[long]") {
  const TemporaryFolder folder;
  CasePlan plan;
  plan.name = "case-007";
  plan.stratum = Stratum::single;
  plan.effects = {{"encoder_scale", "scale"}};
  plan.effects.front().times_background = 4;
  plan.manoeuvres = {"straight-fast", "speed-steps"};
  plan.longest_s = {3, 6};
  plan.unseen = "arc";
  plan.repeats = 1;
  plan.count_scale = 1;
  plan.physics.time_step_s /= 2;
  plan.seed = 3;
  plan.background.numbers = {{"battery.open_circuit_v", 25.7}, {"drive.idle_amperes", 0.309}};
  make_case(plan, folder / "case", 1);
  const HiddenEffect& hidden = plan.effects.front();
  CHECK(hidden.times_background == Approx(4).epsilon(0.06));
  CHECK(hidden.floors == Approx(hidden.times_background * plan.background.floors));
  // tracks that read too much are seen in the drives, and in a replay of what they read, in the pose
  REQUIRE(!hidden.shares.empty());
  CHECK(hidden.shares.front().stage == "command to drive");
  CHECK((hidden.shares.front().share > 0 && hidden.shares.front().share <= 1));

  const runs::Dataset dataset = runs::read_dataset(folder / "case");
  REQUIRE(dataset.runs.size() == 2);
  const runs::Run run = runs::read_run(folder / "case" / dataset.runs[1].file);
  CHECK(run.column("t_s").back() - run.column("t_s").front() == Approx(6).margin(0.011));
  for (const double speed_mps : run.column("track_left_mps"))  // of whole millimetres a second
    CHECK(std::abs(speed_mps * 1000 - std::round(speed_mps * 1000)) < 1e-6);
}

TEST_CASE("Imperfect: a number of the description is as many times as large as the background as asked", "[long]") {
  const TemporaryFolder folder;
  CasePlan plan;
  plan.name = "case-007";
  plan.stratum = Stratum::withheld_number;
  plan.number.key = "track.separation_m";
  plan.number.times_background = 4;
  plan.manoeuvres = {"arc", "turn-in-place"};
  plan.longest_s = {4, 4};
  plan.unseen = "straight";
  plan.repeats = 1;
  plan.seed = 3;
  plan.background.numbers = {{"battery.open_circuit_v", 25.7}, {"drive.idle_amperes", 0.309}};
  make_case(plan, folder / "case", 1);
  CHECK(plan.number.times_background == Approx(4).epsilon(0.06));
  CHECK(plan.number.floors == Approx(plan.number.times_background * plan.background.floors));
  CHECK(find_robot_number(hidden_robot(plan), plan.number.key)->get(hidden_robot(plan)) == Approx(plan.number.value));
  CHECK_FALSE(plan.look_alike.effect.empty());
  CHECK(plan.look_alike.effect != plan.number.key);
}

TEST_CASE("In a turn in place more friction across looks like less along, as only their ratio counts there", "[long]") {
  const TemporaryFolder folder;
  ComparedRuns runs(robot_without_gap("turn-in-place", folder / "case"), 1);
  const Floors floors = floors_around(runs, runs.predictor.unvaried());
  physics::RobotDescription slippery = physics::load_robot(kChallengedRobot);
  slippery.effects.friction_across_scale = 1.02;
  const Differences hidden = shifts_of(runs, slippery, Fidelity::coarse);

  // the flippers are off the ground, so that the friction of the main belts is all there is
  const LookAlike itself = look_alike(runs, floors, hidden, {});
  CHECK((itself.effect == "friction_across" || itself.effect == "track.friction_across"));
  CHECK(itself.angle_deg < 2);
  std::vector<std::string> all_but_along;
  for (const Candidate& c : catalogue_candidates(slippery, false)) all_but_along.push_back(c.effect);
  for (const Candidate& c : description_candidates(slippery)) all_but_along.push_back(c.effect);
  std::erase(all_but_along, "friction_along");
  const LookAlike other = look_alike(runs, floors, hidden, all_but_along);
  CHECK(other.effect == "friction_along");
  CHECK(other.angle_deg < 10);
}

TEST_CASE("How long a solver iterates is no gap, also where tracks a thousandth apart share what the ground holds",
          "[long]") {
  const TemporaryFolder folder;
  ComparedRuns runs(robot_without_gap("speed-steps", folder / "case"), 1);
  std::vector<Variation> models(2, runs.predictor.unvaried());
  for (Variation& model : models) model.robot.effects.drive_asymmetry = 1e-3;
  models[1].physics.solver_iterations *= 2;
  const Floors floors = floors_around(runs, models[0]);
  for (std::size_t s = 0; s < kEachChannelOnce.size(); ++s) {
    const std::vector<Shift> shifts = runs.predictor.shifts(models, kEachChannelOnce[s], Fidelity::every_run);
    // The difference is the sum of two open shapes, by 1 sigma each, and no shape is longer than 1 once it is whitened.
    for (std::size_t r = 0; r < runs.observations.runs.size(); ++r) {
      if (kEachChannelOnce[s] == Passage::command_to_drive)
        CHECK((shifts[1][r] - shifts[0][r]).norm() > 0.1);  // A, mostly; the solver leaves something to iterate for
      CHECK(floors[s].whiteners[r](shifts[1][r] - shifts[0][r]).norm() < std::sqrt(2));
    }
  }
}

TEST_CASE("Of a pair each effect is as large as asked beside the other one", "[long]") {
  // one track that is slower and another one that reads too much: each shows whatever the other one does
  const TemporaryFolder folder;
  CasePlan plan;
  plan.name = "case-007";
  plan.stratum = Stratum::pair;
  plan.effects = {{"drive_asymmetry", "ratio", 6}, {"encoder_scale", "scale", 4}};
  plan.manoeuvres = {"straight"};
  plan.unseen = "arc";
  plan.seed = 3;
  make_case(plan, folder / "case", 1);
  CHECK(plan.effects[0].floors == Approx(6).epsilon(0.1));
  CHECK(plan.effects[1].floors == Approx(4).epsilon(0.1));
}
