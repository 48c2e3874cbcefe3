#include "libkenaf_real/can_transport.hpp"

#include <fmt/format.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>

#include "hrt/error.hpp"
#include "libkenaf_real/heartbeat.hpp"

namespace kenaf::real {
namespace {

using hrt::Error;

constexpr const char* kDriveNames[] = {"track left",          "track right",       "flipper front left",
                                       "flipper front right", "flipper rear left", "flipper rear right"};

}  // namespace

CanTransport::CanTransport() : interrupt_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (interrupt_ < 0) throw Error(HRT_E_INTERNAL, fmt::format("eventfd: {}", std::strerror(errno)));
}

CanTransport::~CanTransport() {
  ::close(interrupt_);
}

hrt::Connection CanTransport::open(const hrt_config& config) {
  const std::span<const std::uint8_t> nodes(config.can_nodes);
  socket_ = std::make_unique<CanSocket>(config.can_interface, nodes);
  const auto patience =
      std::chrono::round<std::chrono::milliseconds>(std::chrono::duration<double>(config.can_timeout_s));
  const NodesHeard heard = listen_for(nodes, socket_->descriptor(), interrupt_, patience);
  std::string missing;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (heard.state.contains(nodes[i])) continue;
    missing += fmt::format("{}{} (node {})", missing.empty() ? "" : ", ", kDriveNames[i], nodes[i]);
  }
  if (!missing.empty()) {
    throw Error(HRT_E_DEVICE,
                fmt::format("no heartbeat on {} within {} s from: {}{}{}; are they powered, is the bit rate "
                            "right, are can_nodes theirs?",
                            config.can_interface, config.can_timeout_s, missing,
                            heard.bus_error.empty() ? "" : "; the bus reports: ", heard.bus_error));
  }
  throw Error(HRT_E_DEVICE,
              fmt::format("all drives answer on {}, but this release of libkenaf_real does not drive them "
                          "yet; nothing was sent, nothing moves",
                          config.can_interface));
}

std::optional<relay::State> CanTransport::wait_state() {
  throw Error(HRT_E_DEVICE, "the drives are not open");
}

void CanTransport::send(const hrt::DriveCommand&) {
  throw Error(HRT_E_DEVICE, "the drives are not open");
}

void CanTransport::interrupt() {
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = write(interrupt_, &one, sizeof one);
}

void CanTransport::close() {
  socket_.reset();
}

}  // namespace kenaf::real
