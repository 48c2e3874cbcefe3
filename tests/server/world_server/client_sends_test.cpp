// How lines reach a client that takes what one recv() returns for whole lines. A socket of packets instead of TCP shows
// each send.
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>

#include "server/world_server/connection.hpp"
#include "tests/server/world_server/conversation.hpp"
#include "tests/support/patience.hpp"

namespace kenaf::world_server {

namespace {

class PacketClient {
 public:
  explicit PacketClient(double speed = 0) : simulation(with_speed(speed)) {
    std::array<int, 2> ends{};
    REQUIRE(::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) == 0);
    fd_ = ends[1];
    connection_ = std::make_shared<Connection>(boost::asio::ip::tcp::socket(io_, boost::asio::ip::tcp::v4(), ends[0]),
                                               simulation, "test", [](Connection&) {});
    connection_->start();
  }
  ~PacketClient() {
    connection_->close();
    io_.poll();
    ::close(fd_);
  }
  PacketClient(const PacketClient&) = delete;
  PacketClient& operator=(const PacketClient&) = delete;

  // Sends, and lets the server handle it: afterwards `handled` is true.
  template <typename Handled>
  void send(const std::string& text, Handled handled) {
    REQUIRE(::send(fd_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size()));
    REQUIRE(support::eventually([&] {
      io_.poll();
      return handled();
    }));
  }
  // One output of the robot.
  void report() {
    simulation.advance(100);
    connection_->flush();
  }
  std::vector<std::string> packets() const {
    std::vector<std::string> all;
    std::array<char, 65536> bytes;
    for (ssize_t got = 0; (got = ::recv(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT)) > 0;)
      all.emplace_back(bytes.data(), static_cast<std::size_t>(got));
    return all;
  }
  Session& session() { return *simulation.sessions.front(); }
  void flush() { connection_->flush(); }
  // What comes until the server has nothing more to send.
  std::vector<std::string> rest() {
    std::vector<std::string> all;
    REQUIRE(support::eventually([&] {
      io_.poll();
      for (std::string& packet : packets()) all.push_back(std::move(packet));
      return simulation.sessions.empty() || session().out.empty();
    }));
    return all;
  }
  void send_last(const std::string& text) {
    REQUIRE(::send(fd_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size()));
    ::shutdown(fd_, SHUT_WR);
  }

  Simulation simulation;

 private:
  static ServerOptions with_speed(double speed) {
    ServerOptions options = fast();
    options.speed = speed;
    return options;
  }
  boost::asio::io_context io_{1};
  std::shared_ptr<Connection> connection_;
  int fd_ = -1;
};

bool is_one_line(std::string_view packet) {
  return packet.ends_with("\r\n") && packet.find('\n') == packet.size() - 1;
}

}  // namespace

TEST_CASE("A client without a Session gets each line by itself") {
  PacketClient client;
  CHECK(client.packets().size() == 1);  // NFO
  client.send("INIT {ClassName USARBot.P2AT} {Name R1}\r\n", [&] { return client.session().robot.has_value(); });
  client.report();
  const std::vector<std::string> packets = client.packets();
  CHECK(packets.size() >= 8);
  for (const std::string& packet : packets) {
    INFO(packet);
    CHECK(is_one_line(packet));
  }
  // What a listener that reads 1024 bytes waits for is whole.
  const auto truth = std::ranges::find_if(
      packets, [](const std::string& packet) { return packet.find("GroundTruth") != std::string::npos; });
  REQUIRE(truth != packets.end());
  CHECK(truth->size() < 1024);
  CHECK(packets.back().starts_with("STA"));
}

TEST_CASE("In real time a line waits until the client has had time to read the one before") {
  PacketClient client(1);
  client.packets();
  client.send("INIT {ClassName USARBot.P2DX} {Name R1}\r\n", [&] { return client.session().robot.has_value(); });
  client.report();
  CHECK(client.packets().size() == 1);
  client.flush();
  CHECK(client.packets().empty());
  const std::vector<std::string> packets = client.rest();
  CHECK(packets.size() >= 7);
  for (const std::string& packet : packets) CHECK(is_one_line(packet));
  CHECK(packets.back().starts_with("STA"));
}

TEST_CASE("What piles up goes at once, in real time too") {
  PacketClient client(1);
  client.packets();
  client.send("INIT {ClassName USARBot.P2DX} {Name R1}\r\n", [&] { return client.session().robot.has_value(); });
  client.report();
  CHECK(client.packets().size() == 1);
  while (client.session().out.size() <= 16384) client.session().out += "SEN {Type Nothing}\r\n";
  client.flush();
  CHECK(client.packets().size() == 1);
  CHECK(client.session().out.empty());
}

TEST_CASE("A client that leaves after its last request is answered all the same") {
  PacketClient client(1);
  client.packets();
  client.send_last("GETSTARTPOSES\r\nPING {Id 1}\r\nPING {Id 2}\r\n");
  std::string all;
  for (const std::string& packet : client.rest()) all += packet;
  REQUIRE(support::eventually([&] {
    for (const std::string& packet : client.rest()) all += packet;
    return client.simulation.sessions.empty();
  }));
  CHECK(all.find("NFO {StartPoses ") != std::string::npos);
  CHECK(all.find("PONG {Id 1}") != std::string::npos);
  CHECK(all.ends_with("PONG {Id 2} {Time 0.0000}\r\n"));
}

TEST_CASE("A client with a Session gets a whole output by one send") {
  PacketClient client(GENERATE(0, 1));
  client.packets();
  client.send("CONTROL {Type Session} {Period 0.01}\r\n", [&] { return client.session().extended; });
  CHECK(client.packets().size() == 1);
  client.send("INIT {ClassName USARBot.P2AT} {Name R1}\r\n", [&] { return client.session().robot.has_value(); });
  client.report();
  CHECK(client.packets().size() == 1);
}

TEST_CASE("Of very many lines at once the first 64 come apart, and none is lost") {
  PacketClient client;
  client.packets();
  std::string pings;
  for (int i = 0; i < 300; ++i) pings += "PING {Id " + std::to_string(i) + "}\n";
  std::vector<std::string> packets;
  client.send(pings, [&] {
    for (std::string& packet : client.packets()) packets.push_back(std::move(packet));
    return !packets.empty();
  });
  REQUIRE(packets.size() == 65);
  for (std::size_t i = 0; i < 64; ++i) CHECK(packets[i] == "PONG {Id " + std::to_string(i) + "} {Time 0.0000}\r\n");
  CHECK(packets[64].starts_with("PONG {Id 64} "));
  CHECK(packets[64].ends_with("PONG {Id 299} {Time 0.0000}\r\n"));
}

}  // namespace kenaf::world_server
