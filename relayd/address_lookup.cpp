#include "relayd/address_lookup.hpp"

#include <netdb.h>
#include <poll.h>

#include <array>
#include <cstring>
#include <future>
#include <stdexcept>
#include <thread>

#include "relayd/mailbox.hpp"

namespace kenaf::relayd {

namespace {

// Returns 0, or the error code of getaddrinfo().
int get_endpoints(const protocol::HostPort& server, int flags, std::vector<Endpoint>& out) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV | flags;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(server.host.c_str(), std::to_string(server.port).c_str(), &hints, &found);
  if (error != 0) return error;
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> owner(found, &::freeaddrinfo);
  for (const addrinfo* at = found; at != nullptr; at = at->ai_next) {
    Endpoint& endpoint = out.emplace_back();
    std::memcpy(&endpoint.address, at->ai_addr, at->ai_addrlen);
    endpoint.size = at->ai_addrlen;
  }
  return 0;
}

}  // namespace

std::vector<Endpoint> look_up(const protocol::HostPort& server) {
  std::vector<Endpoint> endpoints;
  if (const int error = get_endpoints(server, 0, endpoints); error != 0) {
    throw std::runtime_error(::gai_strerror(error));
  }
  return endpoints;
}

struct AddressLookup::UnderWay {
  std::promise<std::vector<Endpoint>> answer;
  Waker done;
};

std::optional<std::vector<Endpoint>> AddressLookup::find(const protocol::HostPort& server, TimePoint deadline,
                                                         int cancel_fd) {
  if (std::vector<Endpoint> in_digits; get_endpoints(server, AI_NUMERICHOST, in_digits) == 0) return in_digits;
  if (!under_way_) {
    under_way_ = std::make_shared<UnderWay>();
    std::thread([ask = ask_, server, under_way = under_way_] {
      try {
        under_way->answer.set_value(ask(server));
      } catch (...) {
        under_way->answer.set_exception(std::current_exception());
      }
      under_way->done.wake();
    }).detach();
  }
  std::array<pollfd, 2> watched{{{under_way_->done.fd(), POLLIN, 0}, {cancel_fd, POLLIN, 0}}};
  ::poll(watched.data(), watched.size(), poll_timeout(deadline));
  if (watched[0].revents != 0) return std::exchange(under_way_, nullptr)->answer.get_future().get();
  if (watched[1].revents != 0) return std::nullopt;
  throw std::runtime_error("its name is not resolved yet: no name server answers");
}

}  // namespace kenaf::relayd
