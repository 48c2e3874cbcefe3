#include "libkenaf_real/can_socket.hpp"

#include <fmt/format.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "hrt/error.hpp"
#include "libkenaf_real/heartbeat.hpp"

namespace kenaf::real {
namespace {

using hrt::Error;

int open_raw_socket() {
  const int descriptor = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, CAN_RAW);
  if (descriptor >= 0) return descriptor;
  switch (errno) {
    case EAFNOSUPPORT:
      throw Error(HRT_E_DEVICE,
                  "this kernel has no SocketCAN (no AF_CAN): load it with `modprobe can`, or run a kernel "
                  "with CONFIG_CAN");
    case EPROTONOSUPPORT:
      throw Error(HRT_E_DEVICE, "this kernel has no raw CAN sockets: load them with `modprobe can_raw`");
    default:
      throw Error(HRT_E_DEVICE, fmt::format("no CAN socket: {}", std::strerror(errno)));
  }
}

// Binds to the interface once it is known to be there, to be a CAN interface and to be up.
void bind_to(int descriptor, const std::string& interface) {
  ifreq request{};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  if (ioctl(descriptor, SIOCGIFINDEX, &request) < 0) {
    throw Error(HRT_E_DEVICE, fmt::format("there is no network interface '{}': `ip link show type can` lists those for "
                                          "CAN; can_interface in kenaf.toml or KENAF_CAN_INTERFACE names it",
                                          interface));
  }
  const int index = request.ifr_ifindex;
  if (ioctl(descriptor, SIOCGIFHWADDR, &request) < 0 || request.ifr_hwaddr.sa_family != ARPHRD_CAN) {
    throw Error(HRT_E_DEVICE, fmt::format("network interface '{}' is not a CAN interface", interface));
  }
  if (ioctl(descriptor, SIOCGIFFLAGS, &request) < 0 || (request.ifr_flags & IFF_UP) == 0) {
    throw Error(HRT_E_DEVICE, fmt::format("CAN interface '{}' is down: `ip link set {} up type can bitrate 1000000`",
                                          interface, interface));
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = index;
  if (bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) < 0) {
    throw Error(HRT_E_DEVICE, fmt::format("CAN interface '{}': {}", interface, std::strerror(errno)));
  }
}

void set_option(int descriptor, int option, const void* value, socklen_t size) {
  if (setsockopt(descriptor, SOL_CAN_RAW, option, value, size) < 0) {
    throw Error(HRT_E_DEVICE, fmt::format("CAN socket option {}: {}", option, std::strerror(errno)));
  }
}

}  // namespace

std::vector<can_filter> heartbeat_filters(std::span<const std::uint8_t> nodes) {
  std::vector<can_filter> filters;
  for (const std::uint8_t node : nodes) {
    // Standard data frames of exactly this identifier: the flags take part in the comparison.
    filters.push_back({.can_id = kHeartbeatId + node, .can_mask = CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG});
  }
  return filters;
}

CanSocket::CanSocket(const std::string& interface, std::span<const std::uint8_t> nodes) : socket_(open_raw_socket()) {
  try {
    const std::vector<can_filter> filters = heartbeat_filters(nodes);
    set_option(socket_, CAN_RAW_FILTER, filters.data(), static_cast<socklen_t>(filters.size() * sizeof(can_filter)));
    const can_err_mask_t errors = CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_TRX | CAN_ERR_ACK | CAN_ERR_BUSOFF |
                                  CAN_ERR_BUSERROR | CAN_ERR_RESTARTED;
    set_option(socket_, CAN_RAW_ERR_FILTER, &errors, sizeof errors);
    bind_to(socket_, interface);
  } catch (...) {
    ::close(socket_);
    throw;
  }
}

CanSocket::~CanSocket() {
  ::close(socket_);
}

}  // namespace kenaf::real
