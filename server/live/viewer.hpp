// A page that looks on: its WebSocket. States that it does not read in time are dropped, all but the newest.
#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <memory>
#include <string>

#include "server/live/hub.hpp"

namespace kenaf::live {

using Message = std::shared_ptr<const std::string>;

class Viewer {
 public:
  // The newest state; one before it that has not been sent yet is dropped.
  virtual void show(const Message& state) = 0;
  // Is sent whatever happens; a viewer that leaves too many unread is let go.
  virtual void tell(const Message& message) = 0;

 protected:
  ~Viewer() = default;
};

// Answers the upgrade, and is in hub.viewers while it is open.
void start_viewer(Hub& hub, boost::beast::tcp_stream stream, PageRequest upgrade);

}  // namespace kenaf::live
