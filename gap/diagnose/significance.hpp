// Tail probabilities of sums of squares.
//
// Thread safety: pure functions.
#pragma once

namespace kenaf::gap::diagnose {

// Tail probability of chi-squared with `freedom` degrees of freedom (Wilson and Hilferty 1931: to 0.001 from three on);
// 1 for no freedom.
double p_of_squares(double sum, double freedom);

// Bound on the probability that the largest of `count` squared standard normals, dependent or not, is larger
// (Bonferroni).
double p_of_largest_square(double square, double count);

}  // namespace kenaf::gap::diagnose
