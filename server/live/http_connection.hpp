// A browser's connection: the page's files, and the site's own routes.
#pragma once

#include <boost/asio/ip/tcp.hpp>

#include "server/live/site.hpp"

namespace kenaf::live {

// Serves until the browser is gone, silent or misbehaves, or the connection is taken over.
void serve_http(Site& site, boost::asio::ip::tcp::socket socket);

}  // namespace kenaf::live
