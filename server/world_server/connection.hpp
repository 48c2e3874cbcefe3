// The socket of one client.
#pragma once

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string_view>

#include "server/world_server/simulation.hpp"

namespace kenaf::world_server {

double steady_seconds();

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  // `closed` is called once, when the client is gone or was disconnected.
  Connection(boost::asio::ip::tcp::socket socket, Simulation& simulation, std::string peer,
             std::function<void(Connection&)> closed);

  void start();
  // Hands the session's output to the system, as far as it accepts it now; the rest follows automatically. A client
  // without a Session gets each line by a send of its own, as from the historic servers, because some take what one
  // recv() returns for whole lines. In real time the lines are also kPause apart, for the client to read each before
  // the next comes. What piles up goes at once. Closes a session that is to be closed.
  void flush();
  void close();
  // Tells the simulation whether the client's machine lives.
  void watch_peer();
  bool has_robot() const { return session_.robot.has_value(); }
  const std::string& peer() const { return session_.peer; }
  double heard_s() const { return heard_s_; }  // steady_seconds() of its last words

 private:
  static constexpr std::size_t kMostLinesApart = 64;  // an output of a robot has half as many; each send takes time
  static constexpr std::size_t kMostPaused_bytes = 16384;
  static constexpr std::chrono::microseconds kPause{1000};

  void read();
  std::size_t send(std::string_view text, boost::system::error_code& error);
  // Passes the bytes on, and goes on with what they began once it is this client's turn again; then reads.
  void take(std::string_view bytes);
  void pause();
  void wait_until_writable();

  boost::asio::ip::tcp::socket socket_;
  Simulation& simulation_;
  Session& session_;
  std::function<void(Connection&)> closed_;
  bool open_ = true;
  bool waiting_ = false;  // until the socket accepts more
  double heard_s_ = steady_seconds();
  boost::asio::steady_timer pause_timer_;
  bool pausing_ = false;  // between two lines
  std::array<char, 16384> received_;
};

}  // namespace kenaf::world_server
