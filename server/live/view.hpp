// The live view: a browser page that shows the world of a WorldServer and drives in it. Described in docs/live-view.md.
//
// HTTP and WebSocket on a separate thread, which asks the world's thread; the world never waits for it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "server/image_server/feed.hpp"
#include "server/live/site.hpp"
#include "server/live/view_options.hpp"
#include "server/world_server/world_server.hpp"

namespace kenaf::live {

struct ViewLimits : SiteLimits {
  std::size_t viewers = 64;          // connections that are WebSockets
  std::size_t pictures = 64;         // connections that read a camera's pictures
  std::size_t message_bytes = 4096;  // per message of a page
  std::size_t unread_answers = 32;   // more, and the page is disconnected; of states it keeps only the newest
  double period_s = 1.0 / 30;        // between states
  int requests_per_s = 100;          // per viewer; beyond that it waits
};

class View {
 public:
  // Listens and serves from construction on. Throws std::runtime_error with a text for the user. The world must outlive
  // this, and this must end while world.run() is not active. The cameras must outlive this too; null: none are
  // available.
  View(world_server::WorldServer& world, const ViewOptions& options, const ViewLimits& limits = {},
       image_server::Feed* cameras = nullptr);
  ~View();
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  std::uint16_t port() const;
  // The address to open in a browser, with the token, if one is needed.
  std::string url() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

// As started by programs: logs its address, or why it is not available; the program continues without it, unless it was
// asked for: then throws std::runtime_error with a text for the user. With a generated token it prints the address on
// standard error if the log does not show it.
std::unique_ptr<View> open_view(world_server::WorldServer& world, const ViewOptions& options,
                                image_server::Feed* cameras);

}  // namespace kenaf::live
