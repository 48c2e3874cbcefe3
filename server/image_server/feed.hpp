// The pictures of all cameras of a world server, drawn on one thread, for any number of readers.
//
// A reader requests a view by its name (view_name.hpp) whenever it wants to see it, and is notified of new frames.
// Views that were not requested for kWanted_s are not drawn; without any, the world is not asked either, and the thread
// sleeps. At each exposure (exposure.hpp) the world's thread hands over a snapshot, which takes microseconds; the scene
// is then updated once for all cameras that expose together. Where nothing has moved since a camera's last picture
// (camera::look_alike), the frame has that picture again.
//
// A frame is published once its camera's latency has passed, in robot time: at twice the speed after half of it. If
// time is stopped or runs as fast as possible, it is published as soon as it is drawn. Speed 0: at most rate_hz
// pictures per second of wall-clock time. Pictures that cannot be drawn in time are skipped, which shows in the frames'
// numbers; no queue builds up.
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
      256;  // at the same time; views without a camera are forgotten first, further ones are refused

  // The world server must outlive this; it need not be running.
  explicit Feed(world_server::WorldServer& world);
  ~Feed();
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;

  // The functions below are for any thread, and wait only for other such calls.

  struct Look {
    std::shared_ptr<const Frame> frame;  // the newest of the view; null: none yet
    std::string none;                    // why there is no frame and will be none; empty: it will come
  };
  // Counts as a request for frames of that size. A camera whose picture could not be drawn stops: `none` says why, in
  // addition to its last frame.
  Look look(std::string_view view, PictureSize size = PictureSize::full);

  // Returns the newest frame of each camera being drawn, of either size. Does not count as a request.
  std::vector<std::shared_ptr<const Frame>> newest() const;

  // `notify` is called on the feed's thread whenever look() may have something new, and never after the returned handle
  // is released. It must only hand over: neither wait nor release a handle.
  std::shared_ptr<void> listen(std::function<void()> notify);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kenaf::image_server
