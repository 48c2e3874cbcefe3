#include "tests/support/usarsim_client.hpp"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "tests/support/loopback.hpp"

namespace kenaf::support {

UsarsimClient::UsarsimClient(std::uint16_t port) : descriptor_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  const sockaddr_in address = test::loopback(port);
  if (::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    const int error = errno;
    ::close(descriptor_);
    throw std::system_error(error, std::generic_category(), "connect to port " + std::to_string(port));
  }
  const timeval limit{20, 0};
  ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  const int on = 1;
  ::setsockopt(descriptor_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

UsarsimClient::~UsarsimClient() {
  ::close(descriptor_);
}

void UsarsimClient::send(std::string_view text) {
  while (!text.empty()) {
    const ssize_t sent = ::send(descriptor_, text.data(), text.size(), MSG_NOSIGNAL);
    if (sent < 0) throw std::system_error(errno, std::generic_category(), "send to the world server");
    text.remove_prefix(static_cast<std::size_t>(sent));
  }
}

std::string UsarsimClient::line() {
  while (true) {
    if (const auto line = lines_.next()) return std::string(*line);
    std::array<char, 65536> bytes;
    const ssize_t got = ::recv(descriptor_, bytes.data(), bytes.size(), 0);
    if (got <= 0) throw std::runtime_error(got == 0 ? "the world server closed" : "the world server is silent");
    lines_.push({bytes.data(), static_cast<std::size_t>(got)});
  }
}

std::string UsarsimClient::line_that_begins(std::string_view start) {
  while (true) {
    std::string next = line();
    if (next.starts_with(start)) return next;
  }
}

double number_in(std::string_view line, std::string_view key) {
  return number_in(line, key, 0);
}

double number_in(std::string_view line, std::string_view key, std::size_t index) {
  protocol::usarsim::MessageView message;
  std::array<double, 256> numbers{};
  if (protocol::usarsim::parse_message(line, message) == protocol::usarsim::ParseError::none) {
    if (const auto value = message.find(key)) {
      const auto count = protocol::usarsim::parse_number_list(*value, numbers);
      if (count && index < *count && index < numbers.size()) return numbers[index];
    }
  }
  throw std::runtime_error("no number " + std::string(key) + " in: " + std::string(line));
}

}  // namespace kenaf::support
