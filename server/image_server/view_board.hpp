// Who looks at which camera, and the newest frames: what the feed's readers and its thread share.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/image_server/exposure.hpp"
#include "server/image_server/feed.hpp"
#include "server/image_server/frame.hpp"

namespace kenaf::image_server {

using FramePtr = std::shared_ptr<const Frame>;
// The sizes in which somebody looks at each camera.
using WantedSizes = std::map<CameraId, BySize<bool>>;

template <typename Value>
bool any_of(const BySize<Value>& values) {
  for (const Value& value : values)
    if (value) return true;
  return false;
}

// Thread safety: any function from any thread; they wait only for each other.
class ViewBoard {
 public:
  // For readers: as Feed::look(). `is_new`: nobody has requested this view in this size lately.
  struct Look {
    Feed::Look seen;
    bool is_new = false;
  };
  Look look(std::string_view view, PictureSize size);
  // As Feed::newest().
  std::vector<FramePtr> newest() const;

  // For the feed's thread. Forgets views that nobody has requested for Feed::kWanted_s, and frames of cameras and sizes
  // that nobody wants; determines what the other views show. `changed`: a view shows another camera than before, or
  // something else keeps it from showing one.
  struct Settled {
    WantedSizes wanted;
    bool changed = false;
  };
  Settled settle(const Exposure& exposure);
  bool is_empty() const;
  // Shows a frame unless a newer one of its size is shown. Returns false if nobody wants it.
  bool show(const FramePtr& frame);
  // The camera's views say so from now on.
  void stop(CameraId id, const std::string& why);

 private:
  using Time = std::chrono::steady_clock::time_point;
  struct View {
    Time since;                          // the first request
    BySize<std::optional<Time>> wanted;  // the last one for each size, if any
    std::optional<CameraId> camera;
    std::string none;

    Time last_wanted() const;
  };
  struct Shown {
    BySize<FramePtr> newest;
    std::string fault;
  };
  bool make_room();

  mutable std::mutex mutex_;
  std::map<std::string, View, std::less<>> views_;
  std::map<CameraId, Shown> shown_;  // of the cameras being drawn
};

}  // namespace kenaf::image_server
