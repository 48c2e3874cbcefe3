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

ErrorOfValue error_of_value(const LinearWorld::Moved& moved, const NumbersOff& numbers = {{1}, kOff}) {
  std::vector<Candidate> candidates(2, world().candidates(1)[0]);
  candidates[1].whole = 1;
  const Whole effect = kPerValue * world().direction(0);
  const StageData data = world().data(kValue * effect);
  StandingModel standing = world().fitted({effect, world().direction(1)}, data, {0});
  standing.curves.candidates = candidates;
  return errors_of_values(data, standing, numbers, world().simulate(moved), 1)[0];
}

double value_in(const Settings& settings, std::size_t candidate) {
  const auto found = std::ranges::find(settings, candidate, &Setting::candidate);
  return found == settings.end() ? 0 : found->value;
}

}  // namespace

TEST_CASE("A number that makes an effect larger by as much leaves its value as much more open than noise does") {
  // an effect of 0.5 that is larger by the number's part: the value is wrong by 0.5 * 0.1. 16 robots tell that to a
  // sixth
  const auto larger = [](const Settings& settings) -> Whole {
    return kPerValue * value_in(settings, 0) * (1 + value_in(settings, 1)) * world().direction(0);
  };
  const ErrorOfValue error = error_of_value(larger);
  CHECK(error.of_noise == Approx(1 / kPerValue));
  CHECK(error.of_numbers == Approx(0.05).epsilon(0.5));
  CHECK(error_of_value(larger, {{1}, 0}).of_numbers == 0);
  // twice as far off, twice as wrong
  CHECK(error_of_value(larger, {{1}, 2 * kOff}).of_numbers == Approx(2 * error.of_numbers));
}

TEST_CASE("What wrong numbers do to the robot without an effect counts by itself") {
  // they move the robot without it like the effect by 0.2, and the one that has it not at all
  const auto only_without = [](const Settings& settings) -> Whole {
    const double value = value_in(settings, 0);
    return kPerValue * (value == 0 ? 2 * value_in(settings, 1) : value) * world().direction(0);
  };
  const ErrorOfValue error = error_of_value(only_without);
  CHECK(error.of_numbers == Approx(0).margin(1e-9));
  CHECK(error.of_numbers_without == Approx(0.2).epsilon(0.5));
  CHECK(error_of_value(only_without, {{1}, kOff, true}).of_numbers_without == 0);
  CHECK(error_of_value(only_without, {{1}, kOff, false, false}).of_numbers_without == 0);
}

TEST_CASE("A number that does something else, or does it in the baseline as well, leaves a value as noise does") {
  const auto beside = [](const Settings& settings) -> Whole {
    return kPerValue * (value_in(settings, 0) * world().direction(0) + value_in(settings, 1) * world().direction(2));
  };
  CHECK(error_of_value(beside).of_numbers == Approx(0).margin(1e-9));
  const auto the_same = [](const Settings& settings) -> Whole {
    return kPerValue * (value_in(settings, 0) + value_in(settings, 1)) * world().direction(0);
  };
  CHECK(error_of_value(the_same).of_numbers > 5 / kPerValue);
  CHECK(error_of_value(the_same, {{1}, kOff, true}).of_numbers == Approx(0).margin(1e-9));
}

TEST_CASE("Errors from 16 robots reach further than as many from noise, and the more so the rarer they are") {
  // Student's t with 16 degrees of freedom: 2.120 for 1.96, 5.364 for 4; both together by their squares
  CHECK(ErrorOfValue{0.1, 0}.half_width() == Approx(0.196));
  CHECK(ErrorOfValue{0.1, 0}.four_sigma() == Approx(0.4));
  CHECK(ErrorOfValue{0, 0.1}.half_width() == Approx(0.2120));
  CHECK(ErrorOfValue{0, 0.1}.four_sigma() == Approx(0.5364));
  CHECK(ErrorOfValue{0.3, 0.1}.four_sigma() == Approx(std::hypot(1.2, 0.5364)));
  // a name needs more than what the robot without the effect could do; an interval is about the one with it
  CHECK(ErrorOfValue{0, 0.1, 0.2}.four_sigma() == Approx(1.0728));
  CHECK(ErrorOfValue{0, 0.1, 0.2}.half_width() == Approx(0.2120));
}

TEST_CASE("An interval becomes wider, never narrower, and stays in the range") {
  const Candidate candidate = world().candidates(1)[0];  // from -1 to 1
  const Interval interval{0.5, 0.4, 0.6};
  const Interval wide = widened(interval, 0.2, candidate);
  CHECK(wide.from == Approx(0.3));
  CHECK(wide.to == Approx(0.7));
  CHECK(widened(interval, 0.01, candidate).to == 0.6);
  CHECK(widened(interval, 2, candidate).to == 1);
}
