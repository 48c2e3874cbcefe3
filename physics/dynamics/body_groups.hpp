// Groups of bodies that push on each other within a step, directly or through others. Groups are independent.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace kenaf::physics {

// Thread safety: a value. No allocation unless there are more bodies than before.
class BodyGroups {
 public:
  // Starts with so many bodies, each in a group of its own.
  void begin(std::size_t bodies);
  void join(std::size_t a, std::size_t b);
  // Call once all are joined. Numbers the groups from 0 on, in the order of their first bodies.
  void number();
  std::size_t count() const { return count_; }
  std::size_t of(std::size_t body) const { return number_[body]; }

 private:
  std::size_t first_of(std::size_t body);

  std::vector<std::size_t> earlier_;  // a body of the same group that comes before it, or itself
  std::vector<std::size_t> number_;
  std::size_t count_ = 0;
};

// The indices of a list's entries, sorted by their group; within a group in the order of the list.
class PlacesByGroup {
 public:
  void make_room(std::size_t places);
  void begin() { group_of_.clear(); }
  // The list's next entry is in that group.
  void add(std::size_t group) { group_of_.push_back(group); }
  void sort(std::size_t groups);
  // Valid after sort().
  std::span<const std::size_t> all() const { return place_; }
  std::size_t begin_of(std::size_t group) const { return group == 0 ? 0 : end_[group - 1]; }
  std::size_t end_of(std::size_t group) const { return end_[group]; }

 private:
  std::vector<std::size_t> group_of_, place_, end_;
};

}  // namespace kenaf::physics
