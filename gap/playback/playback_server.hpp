// Serves a playback as a page, with the access rules of the live view (docs/live-view.md): Host, Origin, token.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "gap/playback/playback.hpp"
#include "server/live/view_options.hpp"

namespace kenaf::gap::playback {

class PlaybackServer {
 public:
  // Listens and serves on a thread of its own; simulates runs on another one when a page requests them. Throws
  // std::runtime_error with words for the user.
  PlaybackServer(Playback playback, const live::ViewOptions& options);
  // Waits for a running simulation.
  ~PlaybackServer();
  PlaybackServer(const PlaybackServer&) = delete;
  PlaybackServer& operator=(const PlaybackServer&) = delete;

  std::uint16_t port() const;
  std::string url() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kenaf::gap::playback
