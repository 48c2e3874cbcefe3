#include "server/live/http_connection.hpp"

#include <algorithm>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <optional>

#include "server/live/access.hpp"
#include "server/live/headers.hpp"

namespace kenaf::live {

namespace {

namespace beast = boost::beast;
namespace http = beast::http;
using beast::error_code;

// A phone may take this long for the largest file.
constexpr std::chrono::seconds kLongestWrite{60};

constexpr std::string_view kWords = "text/plain; charset=utf-8";

using Body = http::span_body<const char>;

class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(Site& site, boost::asio::ip::tcp::socket socket) : site_(site), stream_(std::move(socket)) {
    ++site_.connections;
  }
  ~HttpConnection() { --site_.connections; }
  HttpConnection(const HttpConnection&) = delete;
  HttpConnection& operator=(const HttpConnection&) = delete;

  void read();

 private:
  void handle();
  void answer_path(std::string_view path, std::string_view query);
  bool token_fits(std::string_view query) const {
    return site_.token.empty() || equal_in_constant_time(query_value(query, "token"), site_.token);
  }
  // `bytes` must stay valid: part of the site, of `kept_`, or a literal.
  void send(http::status status, std::string_view type, std::string_view bytes);
  void refuse(http::status status, std::string_view why) {
    keep_ = false;
    send(status, kWords, why);
  }

  Site& site_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  http::response<Body> response_;
  std::shared_ptr<const std::string> kept_;  // data being sent
  bool keep_ = true;
};

void HttpConnection::read() {
  parser_.emplace();
  parser_->header_limit(static_cast<std::uint32_t>(site_.limits.header_bytes));
  parser_->body_limit(0);
  stream_.expires_after(
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(site_.limits.quiet_s)));
  http::async_read(stream_, buffer_, *parser_, [self = shared_from_this()](error_code error, std::size_t) {
    if (!error) return self->handle();
    if (error == http::error::header_limit) self->refuse(http::status::request_header_fields_too_large, "too long\n");
    // on any other error there is no peer left
  });
}

void HttpConnection::handle() {
  const auto& request = parser_->get();
  keep_ = request.keep_alive();
  const std::string_view host(request[http::field::host].data(), request[http::field::host].size());
  if (!host_allowed(host, site_.own_name)) {
    return refuse(http::status::forbidden, "This server answers only requests to its address or its own name.\n");
  }
  if (request.method() != http::verb::get) return refuse(http::status::method_not_allowed, "Only GET is served.\n");
  const std::string_view origin(request[http::field::origin].data(), request[http::field::origin].size());
  if (!origin_allowed(origin, host)) {
    return refuse(http::status::forbidden, "Requests from pages of other servers are refused.\n");
  }
  const std::string_view target(request.target().data(), request.target().size());
  const std::size_t mark = std::min(target.find('?'), target.size());
  answer_path(target.substr(0, mark), target.substr(std::min(mark + 1, target.size())));
}

void HttpConnection::answer_path(std::string_view path, std::string_view query) {
  const std::size_t end = std::min(path.find('/', 1), path.size());
  const auto route = site_.routes.find(path.substr(0, end));
  if (route != site_.routes.end()) {
    if (!token_fits(query)) {
      return refuse(http::status::unauthorized, "This request needs the token that the server printed at its start.\n");
    }
    auto answer = route->second({parser_->get(), path.substr(end), query});
    if (const auto* take_over = std::get_if<TakeOver>(&answer)) {
      return (*take_over)(std::move(stream_), parser_->release());
    }
    Reply& reply = std::get<Reply>(answer);
    kept_ = std::move(reply.bytes);
    if (http::to_status_class(reply.status) != http::status_class::successful) return refuse(reply.status, *kept_);
    return send(reply.status, reply.type, *kept_);
  }
  const auto asset = site_.assets.find(path);
  if (asset == site_.assets.end()) return send(http::status::not_found, kWords, "There is no such file.\n");
  send(http::status::ok, asset->second.type, asset->second.bytes);
}

void HttpConnection::send(http::status status, std::string_view type, std::string_view bytes) {
  response_ = {};
  response_.result(status);
  response_.set(http::field::content_type, {type.data(), type.size()});
  response_.set(http::field::cache_control, "no-cache");
  for (const auto& [name, value] : kSafetyHeaders) response_.set(name, value);
  response_.keep_alive(keep_);
  response_.body() = beast::span<const char>(bytes.data(), bytes.size());
  response_.prepare_payload();
  stream_.expires_after(kLongestWrite);
  http::async_write(stream_, response_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error) return;
    if (self->keep_) return self->read();
    self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, error);
  });
}

}  // namespace

Reply reply_in_words(http::status status, std::string_view words) {
  return {status, kWords, std::make_shared<const std::string>(words)};
}

void serve_http(Site& site, boost::asio::ip::tcp::socket socket) {
  std::make_shared<HttpConnection>(site, std::move(socket))->read();
}

}  // namespace kenaf::live
