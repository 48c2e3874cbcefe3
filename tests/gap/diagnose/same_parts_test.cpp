// A part of an effect that does nothing of its own in these runs.
#include "gap/diagnose/same_parts.hpp"

#include <catch2/catch.hpp>

#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using namespace kenaf::gap::diagnose;
using test::LinearWorld;
using test::Whole;

TEST_CASE("The friction of the main belts is no rival of that of all belts, unless flippers touch the ground") {
  const LinearWorld world({2, 2, 3});
  const StageData data = world.data(world.noise(1));
  std::vector<Candidate> candidates(3);
  candidates[0].effect = "friction_across";
  candidates[1].effect = "track.friction_across";
  candidates[1].part_of = "friction_across";
  candidates[2].effect = "track.width_m";
  candidates[0].present = 1, candidates[0].max = 2;
  candidates[1].present = 0.6, candidates[1].max = 1;
  candidates[2].present = 0.1, candidates[2].max = 0.2;

  // belts on the ground shift by 40 for each doubling of their friction
  const auto kept_where_flippers_shift = [&](double of_flippers) {
    const Simulate simulate = [&](std::span<const Settings> asked, Fidelity) {
      std::vector<GroupVectors> shifts;
      for (const Settings& settings : asked) {
        double main_belts = 1, flippers = 1;
        for (const Setting& setting : settings) {
          if (setting.candidate == 0) main_belts = flippers = setting.value;
          if (setting.candidate == 1) main_belts = setting.value / 0.6;
        }
        shifts.push_back(world.by_group(40 * (main_belts - 1) * world.direction(0) +
                                        of_flippers * (flippers - 1) * world.direction(1)));
      }
      return shifts;
    };
    const std::vector<std::size_t> possible{0, 1, 2};
    return without_same_parts(data, candidates, possible, simulate);
  };
  CHECK(kept_where_flippers_shift(0) == std::vector<std::size_t>{0, 2});
  // 0.2 / 40 is less than 1 %
  CHECK(kept_where_flippers_shift(0.2) == std::vector<std::size_t>{0, 2});
  CHECK(kept_where_flippers_shift(2) == std::vector<std::size_t>{0, 1, 2});
  // nothing is known of a part whose whole is left out
  const std::vector<std::size_t> part_alone{1, 2};
  CHECK(without_same_parts(data, candidates, part_alone, {}) == part_alone);
}
