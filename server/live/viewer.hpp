// A page that views the world: its WebSocket. Of the states that it does not read in time, all but the newest are
// dropped.
#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <memory>
#include <string>

#include "server/live/hub.hpp"
#include "server/live/request.hpp"

namespace kenaf::live {

using Message = std::shared_ptr<const std::string>;

class Viewer {
 public:
  // Sends the newest state; an earlier one not yet sent is dropped.
  virtual void show(const Message& state) = 0;
  // Always sent; a viewer that leaves too many unread is disconnected.
  virtual void tell(const Message& message) = 0;
  // What its states have on top.
  virtual const ShowRequest& shown() const = 0;

 protected:
  ~Viewer() = default;
};

// Answers the upgrade; the viewer is in hub.viewers while it is open.
void start_viewer(Hub& hub, boost::beast::tcp_stream stream, PageRequest upgrade);

}  // namespace kenaf::live
