// A browser's connection: the page's files, and the doors to what the site answers itself.
#pragma once

#include <boost/asio/ip/tcp.hpp>

#include "server/live/site.hpp"

namespace kenaf::live {

// Serves until the browser is gone, silent or wrong, or somebody has taken the connection over.
void serve_http(Site& site, boost::asio::ip::tcp::socket socket);

}  // namespace kenaf::live
