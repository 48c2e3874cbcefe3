// How wrong values are where numbers of the description are off.
#include "gap/diagnose/errors_of_values.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gap/diagnose/linear_world.hpp"

using namespace kenaf;
using namespace kenaf::gap;
using namespace kenaf::gap::candidates;
using namespace kenaf::gap::diagnose;
using test::LinearWorld;
using test::Whole;
using test::world;

namespace {

// Effect 0 at 0.5 shifts by 50 in noise, so that noise alone leaves its value open by 1 / 100. Candidate 1 is a number
// of 1 that may be off by 0.1 (1 sigma), and shifts by `moved` beside the effect.
constexpr double kValue = 0.5, kPerValue = 100, kOff = 0.1;

double error_of_value(const LinearWorld::Moved& moved, bool also_before = false, double numbers_off = kOff) {
  std::vector<Candidate> candidates(2, world().candidates(1)[0]);
  candidates[1].whole = 1;
  const Whole effect = kPerValue * world().direction(0);
  const StageData data = world().data(kValue * effect);
  StandingModel standing = world().fitted({effect, world().direction(1)}, data, {0});
  standing.curves.candidates = candidates;
  return errors_of_values(data, standing, {{1}, numbers_off, also_before}, world().simulate(moved), 1)[0];
}

double value_in(const Settings& settings, std::size_t candidate) {
  const auto found = std::ranges::find(settings, candidate, &Setting::candidate);
  return found == settings.end() ? 0 : found->value;
}

}  // namespace

TEST_CASE("A number that makes an effect larger by as much leaves its value as much more open than noise does") {
  // an effect of 0.5 that is larger by the number's part: the value is wrong by 0.5 * 0.1. Eight robots tell that to a
  // quarter, and stand for it by 2.306 / 1.96 of their root mean square
  const auto larger = [](const Settings& settings) -> Whole {
    return kPerValue * value_in(settings, 0) * (1 + value_in(settings, 1)) * world().direction(0);
  };
  CHECK(error_of_value(larger) == Approx(0.05 * 2.306 / 1.96).epsilon(0.5));
  CHECK(error_of_value(larger, false, 0) == Approx(1 / kPerValue));
  // twice as far off, twice as wrong, apart from noise
  CHECK(error_of_value(larger, false, 2 * kOff) == Approx(2 * error_of_value(larger)).epsilon(0.05));
}

TEST_CASE("A number that does something else, or does it in the baseline as well, leaves a value as noise does") {
  const auto beside = [](const Settings& settings) -> Whole {
    return kPerValue * (value_in(settings, 0) * world().direction(0) + value_in(settings, 1) * world().direction(2));
  };
  CHECK(error_of_value(beside) == Approx(1 / kPerValue));
  const auto the_same = [](const Settings& settings) -> Whole {
    return kPerValue * (value_in(settings, 0) + value_in(settings, 1)) * world().direction(0);
  };
  CHECK(error_of_value(the_same) > 5 / kPerValue);
  CHECK(error_of_value(the_same, true) == Approx(1 / kPerValue));
}

TEST_CASE("An interval becomes wider, never narrower, and stays in the range") {
  const Candidate candidate = world().candidates(1)[0];  // from -1 to 1
  const Interval interval{0.5, 0.4, 0.6};
  const Interval wide = widened(interval, 0.1, candidate);
  CHECK(wide.from == Approx(0.5 - 0.196));
  CHECK(wide.to == Approx(0.5 + 0.196));
  CHECK(widened(interval, 0.01, candidate).to == 0.6);
  CHECK(widened(interval, 1, candidate).to == 1);
}
