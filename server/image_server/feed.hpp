// The pictures of all cameras of a world server, drawn on one thread, for any number of readers.
//
// A reader asks for a view by its name (view_name.hpp) whenever he wants to see it, and is told when there is something
// new. What nobody has asked for during kWanted_s is not drawn; while nobody looks at all, the world is not asked
// either, and the thread sleeps. At each exposure (exposure.hpp) the world's thread hands over a snapshot, microseconds
// of its time; the scene then follows it once for all cameras that expose together.
//
// A frame is published once its camera's latency has passed, in robot time: at twice the speed after half of it. Where
// time stands still, or goes as fast as it can, it is published as soon as it is drawn. Speed 0: at most rate_hz
// pictures a second of wall-clock time. What is not drawn in time is left out, and the frames' numbers say so; nothing
// queues up.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "server/image_server/frame.hpp"
#include "server/world_server/world_server.hpp"

namespace kenaf::image_server {

class Feed {
 public:
  static constexpr double kWanted_s = 2;  // of wall-clock time
  static constexpr std::size_t kMostViews =
      256;  // asked for at the same time, those of no camera forgotten first; further ones are refused

  // The world server must be there until this has ended; whether it runs does not matter.
  explicit Feed(world_server::WorldServer& world);
  ~Feed();
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;

  // What follows is for any thread, and waits for nothing but other such calls.

  struct Look {
    std::shared_ptr<const Frame> frame;  // the newest of the view; null: none yet
    std::string none;                    // why there is none, and will be none; empty: it will come
  };
  // Counts as asking. A camera whose picture could not be drawn stands still: `none` says why, beside its last frame.
  Look look(std::string_view view);

  // The newest frame of each camera that is drawn now. Does not count as asking.
  std::vector<std::shared_ptr<const Frame>> newest() const;

  // `told` is called on the feed's thread whenever look() may have something new for somebody, until the returned
  // handle is gone; from then on never. It must only hand on: neither wait, nor let go of a handle.
  std::shared_ptr<void> listen(std::function<void()> told);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kenaf::image_server
