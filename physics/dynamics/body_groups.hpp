// Which bodies push on each other within a step, directly or by way of others: a group. What happens in one has no
// influence on another.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kenaf::physics {

// Thread safety: a value. No allocation where there were as many bodies before.
class BodyGroups {
 public:
  // Each of so many bodies is by itself.
  void begin(std::size_t bodies);
  void join(std::size_t a, std::size_t b);
  // Once all are joined: numbers the groups from 0 on, in the order of their first bodies.
  void number();
  std::size_t count() const { return count_; }
  std::size_t of(std::size_t body) const { return number_[body]; }

 private:
  std::size_t first_of(std::size_t body);

  std::vector<std::size_t> earlier_;  // a body of the same group that comes before it, or itself
  std::vector<std::size_t> number_;
  std::size_t count_ = 0;
};

// The places in a list, sorted by the group of what is there; within a group in the order of the list.
class PlacesByGroup {
 public:
  void make_room(std::size_t places);
  void begin() { group_of_.clear(); }
  // What comes next in the list is in that group.
  void add(std::size_t group) { group_of_.push_back(group); }
  void sort(std::size_t groups);
  // Once they are sorted.
  std::span<const std::size_t> all() const { return place_; }
  std::size_t begin_of(std::size_t group) const { return group == 0 ? 0 : end_[group - 1]; }
  std::size_t end_of(std::size_t group) const { return end_[group]; }

 private:
  std::vector<std::size_t> group_of_, place_, end_;
};

}  // namespace kenaf::physics
