// The columns of a run that the diagnosis compares between robot and simulation: those of robot::columns(), first what
// is seen at the drives, then at the body, then by sensors.
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
  double resolution;      // finer than this no difference counts, in `unit`
  std::string_view kind;  // channels of one kind stand side by side
  bool level;             // says little where the nose points up or down
};

std::span<const Channel> diagnosis_channels();
// Numbers of kinds, from 0 on, in the order of the channels.
std::size_t kind_of(std::size_t channel);
std::size_t kind_count();
std::string_view kind_name(std::size_t kind);  // "track speed"

}  // namespace kenaf::gap::diagnose
