#include "physics/dynamics/body_groups.hpp"

#include <numeric>
#include <utility>

namespace kenaf::physics {

void BodyGroups::begin(std::size_t bodies) {
  earlier_.resize(bodies);
  std::iota(earlier_.begin(), earlier_.end(), std::size_t{0});
}

// Follows the links to the group's first body; halves the path on its way (union-find).
std::size_t BodyGroups::first_of(std::size_t body) {
  while (earlier_[body] != body) body = earlier_[body] = earlier_[earlier_[body]];
  return body;
}

void BodyGroups::join(std::size_t a, std::size_t b) {
  a = first_of(a);
  b = first_of(b);
  if (a > b) std::swap(a, b);
  earlier_[b] = a;
}

void BodyGroups::number() {
  count_ = 0;
  number_.resize(earlier_.size());
  for (std::size_t i = 0; i < earlier_.size(); ++i) number_[i] = earlier_[i] == i ? count_++ : number_[earlier_[i]];
}

void PlacesByGroup::make_room(std::size_t places) {
  group_of_.reserve(places);
  place_.reserve(places);
}

// Counting sort: end_ counts each group, becomes where each begins, and grows to where it ends as places are filled in.
void PlacesByGroup::sort(std::size_t groups) {
  end_.assign(groups, 0);
  for (const std::size_t group : group_of_) ++end_[group];
  std::exclusive_scan(end_.begin(), end_.end(), end_.begin(), std::size_t{0});
  place_.resize(group_of_.size());
  for (std::size_t i = 0; i < group_of_.size(); ++i) place_[end_[group_of_[i]]++] = i;
}

}  // namespace kenaf::physics
