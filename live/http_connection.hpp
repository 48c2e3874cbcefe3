// A browser's connection: the page's files, the scene, and the door to the WebSocket.
#pragma once

#include <boost/asio/ip/tcp.hpp>

#include "live/hub.hpp"

namespace kenaf::live {

// Serves until the browser is gone, silent or wrong, or has become a Viewer.
void serve_http(Hub& hub, boost::asio::ip::tcp::socket socket);

}  // namespace kenaf::live
