// Tail probabilities of sums of squares.
//
// Thread safety: pure functions.
#pragma once

namespace kenaf::gap::diagnose {

// Chance that a sum of `freedom` squared standard normals is larger (Wilson and Hilferty 1931: to 0.001 from three on);
// 1 without freedom.
double p_of_squares(double sum, double freedom);

// Chance that the largest of `count` squared standard normals, however they depend on each other, is larger
// (Bonferroni).
double p_of_largest_square(double square, double count);

}  // namespace kenaf::gap::diagnose
