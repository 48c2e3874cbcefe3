// The columns of a run that the diagnosis compares between robot and simulation: those of robot::columns(), first of
// the drives, then of the body, then of the sensors.
//
// Thread safety: constants.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "robot/columns.hpp"

namespace kenaf::gap::diagnose {

struct Channel {
  std::string_view column;  // of a `kenaf-runs/1` file
  std::string_view unit;
  bool angle;  // wraps
  robot::Seen seen;
  double resolution;      // smallest difference that counts, in `unit`
  std::string_view kind;  // channels of one kind are adjacent
  bool level;             // of little use while the nose points up or down
};

std::span<const Channel> diagnosis_channels();
// Kinds are numbered from 0 in the order of the channels.
std::size_t kind_of(std::size_t channel);
std::size_t kind_count();
std::string_view kind_name(std::size_t kind);  // "track speed"

}  // namespace kenaf::gap::diagnose
