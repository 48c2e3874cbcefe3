// What a page of recorded runs may ask for.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace kenaf::gap::playback {

struct PlaybackPath {
  std::optional<std::size_t> run;  // from 0; none: the list of all runs
  bool scene = false;              // the run's world, and not the run
};

// What stands behind "/playback": nothing for the list, "/RUN" or "/RUN/scene". nullopt: the path is none of these.
// Whether there is such a run, the caller knows. Pure.
std::optional<PlaybackPath> parse_playback_path(std::string_view path);

}  // namespace kenaf::gap::playback
