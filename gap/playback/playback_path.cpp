#include "gap/playback/playback_path.hpp"

#include <charconv>

namespace kenaf::gap::playback {

std::optional<PlaybackPath> parse_playback_path(std::string_view path) {
  if (path.empty()) return PlaybackPath{};
  if (!path.starts_with('/')) return std::nullopt;
  path.remove_prefix(1);
  std::size_t run = 0;
  const auto [end, error] = std::from_chars(path.data(), path.data() + path.size(), run);
  if (error != std::errc()) return std::nullopt;
  path.remove_prefix(static_cast<std::size_t>(end - path.data()));
  if (!path.empty() && path != "/scene") return std::nullopt;
  return PlaybackPath{run, !path.empty()};
}

}  // namespace kenaf::gap::playback
