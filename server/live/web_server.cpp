#include "server/live/web_server.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

#include "formats/protocol/host_port.hpp"
#include "server/live/access.hpp"
#include "server/live/http_connection.hpp"

namespace kenaf::live {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

tcp::acceptor listen_for_browsers(asio::io_context& io, const ViewOptions& options) {
  try {
    return tcp::acceptor(io, tcp::endpoint(asio::ip::make_address(options.address), options.port));
  } catch (const boost::system::system_error& failure) {
    throw std::runtime_error(fmt::format("cannot listen on {}: {}; choose another address with --view ADDRESS:PORT",
                                         protocol::to_text({options.address, options.port}), failure.code().message()));
  }
}

}  // namespace

std::string machine_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

// On loopback every program belongs to this machine, and Host and Origin restrict browsers to their own pages.
std::string token_for(const ViewOptions& options) {
  if (!options.token.empty() || asio::ip::make_address(options.address).is_loopback()) return options.token;
  return make_token();
}

struct WebServer::Implementation {
  void accept();
  void serve();

  Site& site;
  const std::string address;
  tcp::acceptor acceptor;
  asio::steady_timer accept_again;
  // Without it the context would stop for good in a moment without any pending operation, after a failed accept.
  asio::executor_work_guard<asio::io_context::executor_type> always_work;
  std::thread thread{};
};

void WebServer::Implementation::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) {
      accept();  // first: a browser that cannot be served ends by an exception, and must not end this
      if (site.connections < site.limits.connections) serve_http(site, std::move(socket));
      return;
    }
    accept_again.expires_after(std::chrono::milliseconds(100));  // most often too many open files
    accept_again.async_wait([this](error_code cancelled) {
      if (!cancelled) accept();
    });
  });
}

void WebServer::Implementation::serve() {
  bool accept_anew = false;
  for (;;) {
    try {
      if (accept_anew) {
        error_code ignored;
        acceptor.cancel(ignored);
        accept();
        accept_anew = false;
      }
      site.io.run();
      return;
    } catch (const std::exception& error) {
      spdlog::error("page: {}", error.what());  // concerns one connection; the others are still served
      accept_anew = true;                       // it may have been an accept, whose handler Asio then never calls
    }
  }
}

WebServer::WebServer(Site& site, const ViewOptions& options)
    : impl_(new Implementation{site, options.address, listen_for_browsers(site.io, options),
                               asio::steady_timer(site.io), asio::make_work_guard(site.io)}) {}

WebServer::~WebServer() {
  impl_->site.io.stop();
  if (impl_->thread.joinable()) impl_->thread.join();
}

void WebServer::start() {
  impl_->accept();
  impl_->thread = std::thread([this] { impl_->serve(); });
}

std::uint16_t WebServer::port() const {
  return impl_->acceptor.local_endpoint().port();
}

std::string WebServer::url() const {
  const bool v6 = impl_->address.find(':') != std::string::npos;
  const auto ip = asio::ip::make_address(impl_->address);
  const std::string host =
      ip.is_unspecified() ? impl_->site.own_name : (v6 ? "[" + impl_->address + "]" : impl_->address);
  const std::string& token = impl_->site.token;
  return fmt::format("http://{}:{}/{}{}", host, port(), token.empty() ? "" : "#token=", token);
}

}  // namespace kenaf::live
