// The paths that a page of recorded runs may request.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace kenaf::gap::playback {

struct PlaybackPath {
  std::optional<std::size_t> run;  // from 0; none: the list of all runs
  bool scene = false;              // the run's world, and not the run
};

// Parses what follows "/playback": nothing for the list, "/RUN" or "/RUN/scene"; nullopt otherwise. Does not check that
// the run exists. Pure.
std::optional<PlaybackPath> parse_playback_path(std::string_view path);

}  // namespace kenaf::gap::playback
