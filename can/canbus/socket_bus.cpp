#include "can/canbus/socket_bus.hpp"

#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/bcm.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <vector>

#include "can/canopen/nmt.hpp"

namespace kenaf::canbus {
namespace {

using canopen::BusError;
using canopen::Frame;
using canopen::ReceivedFrame;
using canopen::Time;

constexpr can_err_mask_t kErrorsOfInterest = CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_TRX | CAN_ERR_ACK |
                                             CAN_ERR_BUSOFF | CAN_ERR_BUSERROR | CAN_ERR_RESTARTED;
constexpr Time kLongestSend = std::chrono::milliseconds(20);

Time time_of(const timespec& at) {
  return std::chrono::seconds(at.tv_sec) + Time(at.tv_nsec);
}

Time read_clock(clockid_t clock) {
  timespec at{};
  clock_gettime(clock, &at);
  return time_of(at);
}

struct BothClocks {
  Time wall, monotonic;
};
// Read together: a delay between the two would look like a step of the wall clock.
BothClocks read_both_clocks() {
  constexpr int kTries = 3;
  BothClocks clocks{};
  for (int i = 0; i < kTries; ++i) {
    const Time before = read_clock(CLOCK_MONOTONIC);
    clocks = {read_clock(CLOCK_REALTIME), read_clock(CLOCK_MONOTONIC)};
    if (clocks.monotonic - before < std::chrono::milliseconds(1)) break;
  }
  return clocks;
}

timespec to_timespec(Time duration) {
  const auto seconds = std::chrono::floor<std::chrono::seconds>(duration);
  return {.tv_sec = static_cast<time_t>(seconds.count()), .tv_nsec = static_cast<long>((duration - seconds).count())};
}

int open_socket(int type, int protocol, const char* kind, const char* module) {
  const int descriptor = socket(PF_CAN, type | SOCK_CLOEXEC | SOCK_NONBLOCK, protocol);
  if (descriptor >= 0) return descriptor;
  switch (errno) {
    case EAFNOSUPPORT:
      throw NoBus(
          "this kernel has no SocketCAN (no AF_CAN): load it with `modprobe can`, or run a kernel with CONFIG_CAN");
    case EPROTONOSUPPORT:
      throw NoBus(fmt::format("this kernel has no {} CAN sockets: load them with `modprobe {}`", kind, module));
    default:
      throw NoBus(fmt::format("no CAN socket: {}", std::strerror(errno)));
  }
}

// Returns the address of an interface; fails if it does not exist, is not a CAN interface, or is down.
sockaddr_can address_of(int descriptor, const std::string& interface) {
  ifreq request{};
  interface.copy(request.ifr_name, IFNAMSIZ - 1);
  if (ioctl(descriptor, SIOCGIFINDEX, &request) < 0) {
    throw NoBus(
        fmt::format("there is no network interface '{}': `ip link show type can` lists those for CAN; [can] in "
                    "the robot's description, can_interface in kenaf.toml or KENAF_CAN_INTERFACE names it",
                    interface));
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  if (ioctl(descriptor, SIOCGIFHWADDR, &request) < 0 || request.ifr_hwaddr.sa_family != ARPHRD_CAN)
    throw NoBus(fmt::format("network interface '{}' is not a CAN interface", interface));
  if (ioctl(descriptor, SIOCGIFFLAGS, &request) < 0 || (request.ifr_flags & IFF_UP) == 0) {
    throw NoBus(fmt::format("CAN interface '{0}' is down: `ip link set {0} up type can bitrate 500000`", interface));
  }
  return address;
}

template <typename Option>
void set_option(int descriptor, int level, int option, const Option* values, std::size_t count) {
  if (setsockopt(descriptor, level, option, values, static_cast<socklen_t>(count * sizeof(Option))) < 0)
    throw NoBus(fmt::format("CAN socket option {}: {}", option, std::strerror(errno)));
}

can_frame to_kernel(const Frame& frame) {
  can_frame out{};
  out.can_id = frame.id | (frame.remote ? CAN_RTR_FLAG : 0);
  out.can_dlc = frame.length;
  std::ranges::copy(frame.data, out.data);
  return out;
}

// Accepts standard frames only.
std::optional<Frame> from_kernel(const can_frame& frame) {
  if ((frame.can_id & (CAN_EFF_FLAG | CAN_ERR_FLAG)) != 0 || frame.can_dlc > CAN_MAX_DLEN) return {};
  const auto id = static_cast<std::uint16_t>(frame.can_id & CAN_SFF_MASK);
  if ((frame.can_id & CAN_RTR_FLAG) != 0) return Frame{.id = id, .length = frame.can_dlc, .remote = true};
  return canopen::make_frame(id, {frame.data, frame.can_dlc});
}

// Gives the broadcast manager an order about the SYNC; `frame` is needed to set it up.
bool order_sync(int broadcast_manager, std::uint32_t opcode, Time period, const can_frame* frame) {
  bcm_msg_head head{};
  head.opcode = opcode;
  head.can_id = canopen::kSyncId;
  if (frame) {
    const timespec interval = to_timespec(period);
    head.flags = SETTIMER | STARTTIMER;
    head.ival2.tv_sec = interval.tv_sec;
    head.ival2.tv_usec = interval.tv_nsec / 1000;
    head.nframes = 1;
  }
  can_frame content = frame ? *frame : can_frame{};
  std::array<iovec, 2> parts{{{&head, sizeof head}, {&content, sizeof content}}};
  return writev(broadcast_manager, parts.data(), frame ? 2 : 1) >= 0;
}

}  // namespace

SocketBus::SocketBus(const std::string& interface, std::span<const std::uint16_t> ids) : interface_(interface) {
  try {
    open(ids);
  } catch (...) {
    close();
    throw;
  }
}

SocketBus::~SocketBus() {
  close();
}

void SocketBus::open(std::span<const std::uint16_t> ids) {
  interrupt_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (interrupt_ < 0) throw NoBus(fmt::format("eventfd: {}", std::strerror(errno)));
  raw_ = open_socket(SOCK_RAW, CAN_RAW, "raw", "can_raw");
  if (!ids.empty()) {
    std::vector<can_filter> filters;
    // the flags are compared too: standard data frames with exactly this identifier
    for (const std::uint16_t id : ids)
      filters.push_back({.can_id = id, .can_mask = CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG});
    set_option(raw_, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(), filters.size());
  }
  set_option(raw_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &kErrorsOfInterest, 1);
  const int on = 1;
  set_option(raw_, SOL_SOCKET, SO_TIMESTAMPNS, &on, 1);
  const sockaddr_can address = address_of(raw_, interface_);
  if (bind(raw_, reinterpret_cast<const sockaddr*>(&address), sizeof address) < 0) lost(errno);
  broadcast_manager_ = open_socket(SOCK_DGRAM, CAN_BCM, "broadcast manager", "can_bcm");
  if (connect(broadcast_manager_, reinterpret_cast<const sockaddr*>(&address), sizeof address) < 0) lost(errno);
  suspended();  // counts from here
}

void SocketBus::close() {
  for (const int descriptor : {raw_, broadcast_manager_, interrupt_}) {
    if (descriptor >= 0) ::close(descriptor);
  }
}

void SocketBus::lost(int error) const {
  switch (error) {
    case ENETDOWN:
      throw BusError(fmt::format("CAN interface '{0}' went down: `ip link set {0} up`", interface_));
    case ENODEV:
    case ENXIO:
      throw BusError(fmt::format("CAN interface '{}' no longer exists: is its adapter still plugged in?", interface_));
    default:
      throw BusError(fmt::format("CAN interface '{}': {}", interface_, std::strerror(error)));
  }
}

Time SocketBus::now() const {
  return read_clock(CLOCK_MONOTONIC);
}

Time SocketBus::suspended() {
  const Time before = read_clock(CLOCK_MONOTONIC), boot = read_clock(CLOCK_BOOTTIME),
             after = read_clock(CLOCK_MONOTONIC);
  return suspended_since(suspend_watch_, before, boot, after);
}

void SocketBus::send(const Frame& frame) {
  const can_frame out = to_kernel(frame);
  const Time latest = now() + kLongestSend;
  while (write(raw_, &out, sizeof out) < 0) {
    if (errno == EINTR) continue;
    // ENOBUFS: the interface's queue is full, and no event reports free room in it
    if (errno != ENOBUFS && errno != EAGAIN) lost(errno);
    if (now() > latest) {
      throw canopen::BusFull(
          fmt::format("CAN interface '{}' accepts no more frames: no node acknowledges them, or the bus is off{}{}",
                      interface_, last_warning_.empty() ? "" : "; it reports: ", last_warning_));
    }
    const timespec pause = to_timespec(std::chrono::microseconds(100));
    nanosleep(&pause, nullptr);
  }
}

std::optional<ReceivedFrame> SocketBus::receive(Time until) {
  while (true) {
    if (std::optional<ReceivedFrame> frame = read_frame()) return frame;
    const timespec left = to_timespec(std::max(until - now(), Time(0)));
    std::array<pollfd, 2> watched{{{raw_, POLLIN, 0}, {interrupt_, POLLIN, 0}}};
    const int ready = ppoll(watched.data(), watched.size(), &left, nullptr);
    if (ready == 0) return std::nullopt;
    if ((watched[1].revents & POLLIN) != 0) {
      std::uint64_t count = 0;
      [[maybe_unused]] const ssize_t bytes = read(interrupt_, &count, sizeof count);
      return std::nullopt;
    }
  }
}

std::optional<ReceivedFrame> SocketBus::read_frame() {
  // Skips everything but CANopen frames, until one is found or the socket is empty.
  while (true) {
    can_frame frame{};
    // The frame, and beside it, as a control message, the kernel's time stamp.
    iovec data{.iov_base = &frame, .iov_len = sizeof frame};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timespec))> control{};
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();

    // An empty socket is no error; any other error means that the interface is lost.
    const ssize_t bytes = recvmsg(raw_, &message, 0);
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return std::nullopt;
    if (bytes < 0) lost(errno);
    if (bytes != static_cast<ssize_t>(sizeof frame)) continue;

    // Error frame of the driver: kept for BusFull's message; only bus off is fatal.
    if ((frame.can_id & CAN_ERR_FLAG) != 0) {
      last_warning_ = describe_error_frame(frame.can_id);
      if ((frame.can_id & CAN_ERR_BUSOFF) != 0)
        throw BusError(fmt::format("CAN interface '{}': {}", interface_, last_warning_));
      continue;
    }

    // Skips frames with 29-bit identifiers.
    const std::optional<Frame> received = from_kernel(frame);
    if (!received) continue;
    // The kernel stamps by the wall clock; both clocks, read together, turn that into the monotonic time of the
    // reception.
    Time at = now();
    for (const cmsghdr* part = CMSG_FIRSTHDR(&message); part;
         part = CMSG_NXTHDR(&message, const_cast<cmsghdr*>(part))) {
      if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SCM_TIMESTAMPNS) continue;
      timespec stamp{};
      std::memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
      const BothClocks clocks = read_both_clocks();
      at = received_at(wall_clock_, time_of(stamp), clocks.wall, clocks.monotonic);
    }
    return ReceivedFrame{*received, at};
  }
}

void SocketBus::start_sync(Time period) {
  const can_frame sync = to_kernel(canopen::kSync);
  if (!order_sync(broadcast_manager_, TX_SETUP, period, &sync)) lost(errno);
}

void SocketBus::stop_sync() {
  // fails if the interface is gone, and the order with it: then there is no SYNC either
  order_sync(broadcast_manager_, TX_DELETE, {}, nullptr);
}

void SocketBus::interrupt() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t bytes = write(interrupt_, &one, sizeof one);
}

std::string describe_error_frame(std::uint32_t can_id) {
  if ((can_id & CAN_ERR_BUSOFF) != 0) return "bus off: too many errors; is the bit rate right?";
  if ((can_id & CAN_ERR_ACK) != 0) return "no acknowledgement: is any other node on the bus?";
  if ((can_id & CAN_ERR_TRX) != 0) return "transceiver error: is the cable intact?";
  if ((can_id & CAN_ERR_CRTL) != 0) return "controller error: errors on the bus or too many frames";
  if ((can_id & CAN_ERR_TX_TIMEOUT) != 0) return "sending timed out";
  if ((can_id & CAN_ERR_BUSERROR) != 0) return "bus error: is the bus terminated, and the bit rate right?";
  if ((can_id & CAN_ERR_RESTARTED) != 0) return "controller restarted";
  return "unknown error";
}

}  // namespace kenaf::canbus
