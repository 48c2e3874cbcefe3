// The live view: a page in a browser that shows the world of a WorldServer and drives in it. docs/live-view.md is the
// page for people.
//
// HTTP and WebSocket on a thread of its own, which asks the world's thread and is never waited for by it.
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
  std::size_t viewers = 64;          // of its connections, WebSockets
  std::size_t pictures = 64;         // of its connections, readers of a camera's pictures
  std::size_t message_bytes = 4096;  // that a page sends
  std::size_t unread_answers = 32;   // then a page is let go; of states it keeps the newest only
  double period_s = 1.0 / 30;        // between states
  int requests_per_s = 100;          // of a viewer; then it waits
};

class View {
 public:
  // Listens, and serves from then on. Throws std::runtime_error in words. The world must be there until this has ended,
  // and this must end while world.run() is not under way. The cameras must be there as long; null: there are none to
  // see.
  View(world_server::WorldServer& world, const ViewOptions& options, const ViewLimits& limits = {},
       image_server::Feed* cameras = nullptr);
  ~View();
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  std::uint16_t port() const;
  // What to open in a browser, with the token, where one is needed.
  std::string url() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

// As programs start it: says in the log where it is, or why it is not there, and the program goes on without it. With a
// token that was made it says on standard error where it is, if the log does not.
std::unique_ptr<View> open_view(world_server::WorldServer& world, const ViewOptions& options,
                                image_server::Feed* cameras);

}  // namespace kenaf::live
