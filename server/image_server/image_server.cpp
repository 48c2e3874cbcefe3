#include "server/image_server/image_server.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <map>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "formats/protocol/host_port.hpp"
#include "server/image_server/image_connection.hpp"

namespace kenaf::image_server {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

tcp::acceptor listen_for_readers(asio::io_context& io, const std::string& address, std::uint16_t port) {
  error_code error;
  const std::optional<std::string> host = protocol::parse_listen_host(address);
  const auto ip = asio::ip::make_address(host.value_or(""), error);
  if (!host || error) throw std::runtime_error(fmt::format("\"{}\" {}", address, protocol::kMustBeListenHost));
  try {
    return tcp::acceptor(io, tcp::endpoint(ip, port));
  } catch (const boost::system::system_error& failure) {
    throw std::runtime_error(fmt::format("cannot listen on {}: {}; choose another port with --camera-port",
                                         protocol::to_text({*host, port}), failure.code().message()));
  }
}

}  // namespace

struct ImageServer::Implementation {
  Implementation(Feed& feed, const std::string& address, std::uint16_t port, ImageType type,
                 const ImageServerLimits& limits)
      : desk{feed, limits, type}, acceptor(listen_for_readers(io, address, port)) {}

  void accept();
  void welcome(tcp::socket socket);
  bool make_room();
  void serve();

  ImageDesk desk;
  asio::io_context io{1};
  // Without it the context would stop for good in a moment without any pending operation, after a failed accept.
  asio::executor_work_guard<asio::io_context::executor_type> always_work{io.get_executor()};
  tcp::acceptor acceptor;
  asio::steady_timer accept_again{io};
  std::shared_ptr<void> listening;
  std::thread thread;
};

void ImageServer::Implementation::accept() {
  acceptor.async_accept([this](error_code error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) {
      accept();  // first: a reader that cannot be served ends by an exception, and must not end this
      return welcome(std::move(socket));
    }
    accept_again.expires_after(std::chrono::milliseconds(100));  // most often too many open files
    accept_again.async_wait([this](error_code cancelled) {
      if (!cancelled) accept();
    });
  });
}

void ImageServer::Implementation::welcome(tcp::socket socket) {
  if (desk.readers.size() >= desk.limits.connections && !make_room()) return;
  serve_images(desk, std::move(socket));
}

// Closes the reader that has been idle longest; false: none has been so for long enough.
bool ImageServer::Implementation::make_room() {
  using Steady = std::chrono::steady_clock;
  const auto idle_since = [](const ImageReader* reader) {
    return reader->idle_since().value_or(Steady::time_point::max());
  };
  const auto idlest = std::ranges::min_element(desk.readers, {}, idle_since);
  const auto idle = std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(desk.limits.idle_s));
  if (idlest == desk.readers.end() || idle_since(*idlest) > Steady::now() - idle) return false;
  (*idlest)->give_way();
  return true;
}

void ImageServer::Implementation::serve() {
  pthread_setname_np(pthread_self(), "kenaf-images");
  bool accept_anew = false;
  for (;;) {
    try {
      if (accept_anew) {
        error_code ignored;
        acceptor.cancel(ignored);
        accept();
        accept_anew = false;
      }
      io.run();
      return;
    } catch (const std::exception& error) {
      spdlog::error("image server: {}", error.what());  // concerns one connection; the others are still served
      accept_anew = true;  // it may have been an accept, whose handler Asio then never calls
    }
  }
}

ImageServer::ImageServer(Feed& feed, const std::string& address, std::uint16_t port, ImageType type,
                         const ImageServerLimits& limits)
    : impl_(std::make_unique<Implementation>(feed, address, port, type, limits)) {
  Implementation& server = *impl_;
  server.accept();
  server.listening = feed.listen([&server] {
    asio::post(server.io, [&server] {
      for (std::size_t i = server.desk.readers.size(); i-- > 0;) server.desk.readers[i]->look();
    });
  });
  server.thread = std::thread([&server] { server.serve(); });
}

ImageServer::~ImageServer() {
  impl_->listening.reset();
  impl_->io.stop();
  impl_->thread.join();
}

std::uint16_t ImageServer::port() const {
  return impl_->acceptor.local_endpoint().port();
}

}  // namespace kenaf::image_server
