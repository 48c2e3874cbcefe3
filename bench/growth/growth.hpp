// How a cost grows with an amount: measured points, and the exponent that they show.
//
// Thread safety: values and pure functions.
#pragma once

#include <string>
#include <vector>

namespace kenaf::bench {

struct Point {
  double amount;
  double cost;  // positive
};

struct Growth {
  std::string of;             // "contacts of a robot on bars"
  std::string unit;           // of the cost: "us a step"
  std::vector<Point> points;  // by rising amount, at least two
  double ought;               // the exponent that the task itself has: 1 for a robot more, -1 for a core more
};

// Returns k of cost = c amount^k between the two largest amounts, where what does not grow hides least of it.
double last_exponent(const Growth& growth);

// Returns k of the least-squares line through all points, over logarithms.
double fitted_exponent(const Growth& growth);

// Returns a row of a Markdown table, and its head.
std::string table_head();
std::string table_row(const Growth& growth);

}  // namespace kenaf::bench
