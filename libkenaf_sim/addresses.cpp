#include "libkenaf_sim/addresses.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <future>
#include <memory>
#include <utility>

#include "hrt/error.hpp"
#include "hrt/quiet_thread.hpp"

namespace kenaf::sim {
namespace {

int get_addresses(const protocol::HostPort& name, int socket_type, int flags, Addresses& out) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICSERV | flags;
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = socket_type;
  addrinfo* found = nullptr;
  const int wrong = getaddrinfo(name.host.c_str(), std::to_string(name.port).c_str(), &hints, &found);
  if (wrong != 0) return wrong;
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, &freeaddrinfo);
  for (const addrinfo* at = found; at != nullptr; at = at->ai_next) {
    Address& address = out.emplace_back();
    std::memcpy(&address.address, at->ai_addr, at->ai_addrlen);
    address.size = at->ai_addrlen;
  }
  return 0;
}

struct Answer {
  int wrong = 0;
  Addresses found;
};

// What the thread of a look-up and the one that waits for it share; the later one to end frees it.
struct UnderWay {
  UnderWay() : done(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (done < 0) throw hrt::Error(HRT_E_INTERNAL, fmt::format("eventfd: {}", std::strerror(errno)));
  }
  ~UnderWay() { ::close(done); }
  UnderWay(const UnderWay&) = delete;
  UnderWay& operator=(const UnderWay&) = delete;

  const int done;  // readable once there is an answer
  std::promise<Answer> answer;
};

enum class Waited { answered, cancelled, too_late };

Waited wait_for(int done, int cancel_fd, TimePoint deadline) {
  std::array<pollfd, 2> watched{{{done, POLLIN, 0}, {cancel_fd, POLLIN, 0}}};
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - TimePoint::clock::now()).count();
    const int milliseconds = static_cast<int>(std::clamp<std::int64_t>(left, 0, 60000));
    const int ready = poll(watched.data(), watched.size(), milliseconds);
    if (ready > 0) return watched[0].revents != 0 ? Waited::answered : Waited::cancelled;
    if (left <= 0) return Waited::too_late;
  }
}

// Whether another try may find the name.
bool is_passing(int wrong) {
  return wrong == EAI_AGAIN || wrong == EAI_FAIL || wrong == EAI_SYSTEM;
}

}  // namespace

int ask_system(const protocol::HostPort& name, int socket_type, Addresses& found) {
  return get_addresses(name, socket_type, 0, found);
}

std::optional<Addresses> look_up(const char* key, const std::string& host_port, int socket_type, TimePoint deadline,
                                 int cancel_fd, const AskForAddresses& ask) {
  const std::optional<protocol::HostPort> name = protocol::parse_host_port(host_port);
  if (!name || name->port == 0) {
    throw hrt::Error(HRT_E_CONFIG,
                     fmt::format("{} must be HOST:PORT with a port from 1 to 65535, not '{}'", key, host_port));
  }
  if (Addresses in_digits; get_addresses(*name, socket_type, AI_NUMERICHOST, in_digits) == 0) return in_digits;

  const auto under_way = std::make_shared<UnderWay>();
  hrt::start_quiet_thread([ask, name = *name, socket_type, under_way] {
    try {
      Answer answer;
      answer.wrong = ask(name, socket_type, answer.found);
      under_way->answer.set_value(std::move(answer));
    } catch (...) {
      under_way->answer.set_exception(std::current_exception());
    }
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(under_way->done, &one, sizeof one);
  }).detach();
  switch (wait_for(under_way->done, cancel_fd, deadline)) {
    case Waited::answered:
      break;
    case Waited::cancelled:
      return std::nullopt;
    case Waited::too_late:
      throw hrt::Error(HRT_E_LINK, fmt::format("{} '{}': no name server has answered within connect_timeout_s; check "
                                               "the network, or give the address in digits",
                                               key, host_port));
  }
  Answer answer = under_way->answer.get_future().get();
  if (answer.wrong == 0 && !answer.found.empty()) return std::move(answer.found);
  const std::string why = gai_strerror(answer.wrong == 0 ? EAI_NONAME : answer.wrong);
  if (!is_passing(answer.wrong)) throw hrt::Error(HRT_E_CONFIG, fmt::format("{} '{}': {}", key, host_port, why));
  throw hrt::Error(HRT_E_LINK,
                   fmt::format("{} '{}': {}; check the network, or give the address in digits", key, host_port, why));
}

}  // namespace kenaf::sim
