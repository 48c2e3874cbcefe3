// State of a page server that its connections share: the page's files, access rights, and routes for paths that are no
// files. The live view and the playback of recorded runs are two such sites (view.cpp, gap/playback/).
//
// For the server's thread only (server/live/web_server.hpp).
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/status.hpp>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include "server/live/assets.hpp"

namespace kenaf::live {

struct SiteLimits {
  std::size_t connections = 128;  // of browsers; further ones are closed at once
  std::size_t header_bytes = 8192;
  double quiet_s = 10;  // without a request, after which the connection is closed
};

// A GET accepted by the checks of Host, Origin and token.
using PageRequest = boost::beast::http::request<boost::beast::http::empty_body>;
struct Visit {
  const PageRequest& request;
  std::string_view rest;  // the path after its first part: "/3" of "/playback/3"
  std::string_view query;
};

struct Reply {
  boost::beast::http::status status;
  std::string_view type;  // a literal
  std::shared_ptr<const std::string> bytes;
};
// "There is no such file.", and other short texts for people.
Reply reply_in_words(boost::beast::http::status status, std::string_view words);

// Another owner takes over the connection: a WebSocket or a stream. It still counts in Site::connections.
using TakeOver = std::function<void(boost::beast::tcp_stream, PageRequest)>;

// Returns at once; lengthy work is prepared elsewhere, and the page asks again.
using Route = std::function<std::variant<Reply, TakeOver>(const Visit&)>;

struct Site {
  const SiteLimits limits;
  const std::string token;     // empty: none is needed
  const std::string own_name;  // of this machine
  const Assets assets;
  std::map<std::string, Route, std::less<>> routes{};  // by the path's first part: "/ws"; all require the token

  std::size_t connections = 0;

  // Last, so that it is destroyed first: its handlers refer to the others.
  boost::asio::io_context io{1};
};

}  // namespace kenaf::live
