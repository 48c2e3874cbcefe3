// Tail probabilities against tables.
#include "gap/diagnose/significance.hpp"

#include <catch2/catch.hpp>

using namespace kenaf::gap;
using namespace kenaf::gap::diagnose;

TEST_CASE("The chance of a sum of squares, against the tables of chi-squared") {
  CHECK(p_of_squares(7.815, 3) == Approx(0.05).margin(0.001));
  CHECK(p_of_squares(12.838, 3) == Approx(0.005).margin(0.001));
  CHECK(p_of_squares(18.307, 10) == Approx(0.05).margin(0.001));
  CHECK(p_of_squares(9.342, 10) == Approx(0.5).margin(0.001));
  CHECK(p_of_squares(124.342, 100) == Approx(0.05).margin(0.0005));
  CHECK(p_of_squares(135.807, 100) == Approx(0.01).margin(0.0005));
  CHECK(p_of_squares(3.841, 1) == Approx(0.05).margin(0.005));  // coarser below three
}

TEST_CASE("Nothing that could differ has any sum by chance") {
  CHECK(p_of_squares(100, 0) == 1);
}

TEST_CASE("The chance of the largest of several squares is at most the sum of their chances") {
  CHECK(p_of_largest_square(3.841, 1) == Approx(0.05).epsilon(0.001));
  CHECK(p_of_largest_square(6.635, 1) == Approx(0.01).epsilon(0.001));
  CHECK(p_of_largest_square(6.635, 70) == Approx(0.7).epsilon(0.001));
  CHECK(p_of_largest_square(3.841, 70) == 1);
  CHECK(p_of_largest_square(-2, 5) == 1);  // an improvement that is none
}
