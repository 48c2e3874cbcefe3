#include "server/world_server/connection.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <chrono>
#include <exception>

#include "server/world_server/peer_life.hpp"

namespace kenaf::world_server {

using boost::system::error_code;
namespace asio = boost::asio;

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Connection::Connection(asio::ip::tcp::socket socket, Simulation& simulation, std::string peer,
                       std::function<void(Connection&)> closed)
    : socket_(std::move(socket)),
      simulation_(simulation),
      session_(simulation.connect(std::move(peer))),
      closed_(std::move(closed)),
      pause_timer_(socket_.get_executor()) {}

void Connection::start() {
  error_code ignored;  // a client that is gone already shows at the first read
  socket_.non_blocking(true, ignored);
  socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
  end_with_peer(socket_.native_handle());
  flush();
  if (open_) read();
}

void Connection::read() {
  socket_.async_read_some(asio::buffer(received_), [self = shared_from_this()](error_code error, std::size_t count) {
    if (!self->open_) return;
    self->simulation_.catch_up(steady_seconds());
    if (error) return self->close();
    self->heard_s_ = steady_seconds();
    self->take({self->received_.data(), count});
  });
}

// Returns the number of bytes that the system took.
std::size_t Connection::send(std::string_view text, error_code& error) {
  const auto write = [&](std::string_view piece) {
    return socket_.write_some(asio::buffer(piece.data(), piece.size()), error);
  };
  const bool apart = !session_.extended && text.size() <= kMostPaused_bytes;
  const double speed = simulation_.clock.speed();
  std::size_t sent = 0;
  for (std::size_t lines = 0; apart && lines < kMostLinesApart; ++lines) {
    const std::size_t end = text.find('\n', sent);
    if (end == std::string_view::npos) break;
    sent += write(text.substr(sent, end + 1 - sent));
    if (sent != end + 1 || sent == text.size()) return sent;
    if (speed > 0 && speed <= 1 && !session_.close) {
      pause();
      return sent;
    }
  }
  return sent + write(text.substr(sent));
}

void Connection::pause() {
  pause_timer_.expires_after(kPause);
  pause_timer_.async_wait([self = shared_from_this()](error_code cancelled) {
    self->pausing_ = false;
    if (!cancelled) self->flush();
  });
  pausing_ = true;  // not earlier: the wait may throw
}

void Connection::take(std::string_view bytes) {
  if (!open_) return;
  try {
    const bool more = simulation_.receive(session_, bytes, steady_seconds());
    flush();
    if (!open_) return;
    if (!more) return read();
    asio::post(socket_.get_executor(), [self = shared_from_this()] { self->take({}); });
  } catch (const std::exception& failure) {  // one client's input must not end the world of the others
    spdlog::error("{}: closed: it sent data that cannot be handled: {}", session_.peer, failure.what());
    close();
  }
}

void Connection::flush() {
  if (!open_) return;
  if (session_.out.empty()) return session_.close ? close() : void();
  if (pausing_ && !session_.close && session_.out.size() <= kMostPaused_bytes) return;
  if (!waiting_) {
    error_code error;
    session_.out.erase(0, send(session_.out, error));
    if (error && error != asio::error::would_block) return close();
  }
  if (session_.out.size() > kMostUnread_bytes) {
    if (!session_.close) spdlog::warn("{}: closed: it does not read its messages", session_.peer);
    return close();
  }
  if (session_.close) return close();
  if (!session_.out.empty() && !waiting_ && !pausing_) wait_until_writable();
}

void Connection::watch_peer() {
  if (open_) simulation_.note_peer(session_, unheard_of_s(socket_.native_handle()));
}

void Connection::wait_until_writable() {
  socket_.async_wait(asio::ip::tcp::socket::wait_write, [self = shared_from_this()](error_code error) {
    self->waiting_ = false;
    if (!self->open_) return;
    if (error) return self->close();
    self->flush();
  });
  waiting_ = true;  // not earlier: the wait may throw
}

void Connection::close() {
  if (!open_) return;
  open_ = false;
  error_code ignored;
  // A client that has sent its last request still reads the answers.
  if (pausing_) socket_.write_some(asio::buffer(session_.out), ignored);
  pause_timer_.cancel();
  socket_.close(ignored);
  simulation_.disconnect(session_);
  closed_(*this);
}

}  // namespace kenaf::world_server
