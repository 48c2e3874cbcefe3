// What a server of pages knows and its connections share: the page's files, who may ask, and how a path is answered
// that is no file. The live view and the playback of recorded runs are two such sites (view.cpp, gap/playback/).
//
// On the server's thread alone (server/live/web_server.hpp).
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
  double quiet_s = 10;  // without a request: the connection is closed
};

// A GET that Host, Origin and token let in.
using PageRequest = boost::beast::http::request<boost::beast::http::empty_body>;
struct Visit {
  const PageRequest& request;
  std::string_view rest;  // of the path behind its first part: "/3" of "/playback/3"
  std::string_view query;
};

struct Reply {
  boost::beast::http::status status;
  std::string_view type;  // a literal
  std::shared_ptr<const std::string> bytes;
};
// "There is no such file.", and other short words for a person.
Reply reply_in_words(boost::beast::http::status status, std::string_view words);

// The connection is somebody else's from now on: a WebSocket's, or a stream's. He counts in Site::connections.
using TakeOver = std::function<void(boost::beast::tcp_stream, PageRequest)>;

// Returns at once; what takes long is prepared elsewhere, and the page asks again.
using Route = std::function<std::variant<Reply, TakeOver>(const Visit&)>;

struct Site {
  const SiteLimits limits;
  const std::string token;     // empty: none is needed
  const std::string own_name;  // of this machine
  const Assets assets;
  std::map<std::string, Route, std::less<>> routes{};  // by the path's first part: "/ws"; all need the token

  std::size_t connections = 0;

  // Last, so that it ends first: what its handlers hold knows the others.
  boost::asio::io_context io{1};
};

}  // namespace kenaf::live
