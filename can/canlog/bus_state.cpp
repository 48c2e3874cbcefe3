#include "can/canlog/bus_state.hpp"

#include "can/canlog/node_states.hpp"

namespace kenaf::canlog {

std::optional<WrittenObject> BusState::on_frame(const LogFrame& logged) {
  if (logged.kind != canopen::FrameKind::data) return std::nullopt;
  const Address address = setup_.address_of(logged.frame.id);
  if (address.service == Service::nmt || address.service == Service::heartbeat) {
    for (const auto& [node, name] : network_.names()) {
      if (!NodeStates::is_restart(logged, address, node)) continue;
      setup_.on_restart(node);
      dialogue_.on_restart(node);
    }
  }
  auto written = dialogue_.on_frame(logged, address);
  if (written) setup_.on_write(logged, *written);
  return written;
}

}  // namespace kenaf::canlog
