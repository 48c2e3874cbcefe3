#include "can/candrives/gyro.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::candrives {

using canopen::MappedObject;
using canopen::ObjectType;

namespace {

constexpr std::uint16_t kRawBytes = 0x2000;
constexpr std::uint8_t kAtEachSync = 1;

std::uint8_t byte_count_of(const canbus::GyroOnBus& setup) {
  return static_cast<std::uint8_t>((setup.first_bit + setup.bits + 7) / 8);
}

MappedObject raw_byte(std::uint8_t number) {
  return {{kRawBytes, number}, ObjectType::unsigned8};
}

std::vector<DefaultPdo> pdos(const canbus::GyroOnBus& setup) {
  std::vector<MappedObject> bytes;
  for (std::uint8_t i = 1; i <= byte_count_of(setup); ++i) bytes.push_back(raw_byte(i));
  return {{{canopen::PdoDirection::transmit, setup.pdo, kAtEachSync, bytes}}};
}

}  // namespace

Gyro::Gyro(const canbus::GyroOnBus& setup)
    : Slave(setup.node, {.name = "Kenaf simulated gyro", .product_code = 1, .revision = 1, .serial_number = setup.node},
            pdos(setup)),
      setup_(setup) {
  dictionary().add({{kRawBytes, 0}, ObjectType::unsigned8}, Access::read_only, Mappable::no, byte_count_of(setup));
  for (std::uint8_t i = 1; i <= byte_count_of(setup); ++i)
    dictionary().add(raw_byte(i), Access::read_only, Mappable::transmit, 0);
}

void Gyro::refresh() {
  const double end = std::ldexp(1.0, setup_.bits - 1);
  const double rate = std::clamp(yaw_rate_radps_ * setup_.units_per_radps, -end, end - 1);
  const auto number = static_cast<std::uint64_t>(std::llround(rate));
  const std::uint64_t mask = setup_.bits < 64 ? (std::uint64_t{1} << setup_.bits) - 1 : ~std::uint64_t{0};
  const std::uint64_t placed = (number & mask) << setup_.first_bit;
  for (std::uint8_t i = 1; i <= byte_count_of(setup_); ++i)
    dictionary().set(raw_byte(i).object, static_cast<std::int64_t>(placed >> 8 * (i - 1) & 0xff));
}

}  // namespace kenaf::candrives
