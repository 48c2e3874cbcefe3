#include "can/candrives/drive_objects.hpp"

#include "can/candrives/homing.hpp"

namespace kenaf::candrives {

using canopen::DriveMode;
using canopen::PdoDirection;
using canopen::SdoAbort;

namespace {

constexpr DriveMode kModes[] = {DriveMode::profile_position, DriveMode::profile_velocity, DriveMode::homing,
                                DriveMode::cyclic_position, DriveMode::cyclic_velocity};

std::uint32_t supported_modes() {
  std::uint32_t bits = 0;
  for (const DriveMode mode : kModes) bits |= 1u << (static_cast<int>(mode) - 1);
  return bits;
}

template <typename... Values>
std::optional<SdoAbort> one_of(std::int64_t value, Values... allowed) {
  if (((value == allowed) || ...)) return std::nullopt;
  return SdoAbort::invalid_value;
}

}  // namespace

void add_drive_objects(Dictionary& objects, OptionalDriveObjects has) {
  const auto fixed = [&](const canopen::MappedObject& at, std::int64_t value) {
    objects.add(at, Access::read_only, Mappable::no, value);
  };
  const auto measured = [&](const canopen::MappedObject& at) {
    objects.add(at, Access::read_only, Mappable::transmit, 0);
  };
  const auto setting = [&](const canopen::MappedObject& at, std::int64_t value) {
    objects.add(at, Access::read_write, Mappable::no, value);
  };
  const auto command = [&](const canopen::MappedObject& at, std::int64_t value) {
    objects.add(at, Access::read_write, Mappable::both, value);
  };
  const auto ramp = [&](const canopen::MappedObject& at, std::int64_t value) {
    objects.add(at, Access::read_write, Mappable::receive, value, {1, range_of(at.type).max});
  };

  command(object::controlword, 0);
  measured(object::statusword);
  measured(object::error_code);
  command(object::mode, static_cast<int>(DriveMode::profile_position));
  measured(object::mode_display);
  fixed(object::supported_modes, supported_modes());

  setting(object::abort_connection_option, kAbortByFault);
  setting(object::quick_stop_option, kQuickStopRamp);
  fixed(object::shutdown_option, kDisableDrive);
  fixed(object::disable_operation_option, kDisableDrive);
  setting(object::fault_reaction_option, kQuickStopRamp);

  measured(object::position_actual);
  measured(object::velocity_actual);
  if (has.current) {
    measured(object::current_actual);
    fixed(object::rated_current, 10'000);  // mA
  }
  if (has.voltage) measured(object::dc_link_voltage);
  measured(object::following_error);

  command(object::target_position, 0);
  command(object::target_velocity, 0);
  setting(object::following_error_window, 0xffffffff);  // none
  setting(object::following_error_timeout_ms, 100);
  setting(object::position_window, 2'000);
  setting(object::velocity_window, 2'000);
  setting(object::velocity_threshold, 500);

  fixed({{object::position_limit_min.object.index, 0}, canopen::ObjectType::unsigned8}, 2);
  setting(object::position_limit_min, 0);
  setting(object::position_limit_max, 0);
  setting(object::max_profile_velocity, 50'000);
  objects.add(object::profile_velocity, Access::read_write, Mappable::receive, 1'000);
  ramp(object::profile_acceleration, 10'000);
  ramp(object::profile_deceleration, 10'000);
  ramp(object::quick_stop_deceleration, 50'000);

  setting(object::home_offset, 0);
  setting(object::homing_method, 37);
  fixed({{object::homing_speed_switch.object.index, 0}, canopen::ObjectType::unsigned8}, 2);
  setting(object::homing_speed_switch, 1'000);
  setting(object::homing_speed_zero, 100);
  objects.add(object::homing_acceleration, Access::read_write, Mappable::no, 10'000, {1, 0xffffffff});

  fixed({{object::interpolation_period.object.index, 0}, canopen::ObjectType::unsigned8}, 2);
  objects.add(object::interpolation_period, Access::read_write, Mappable::no, 1, {1, 255});
  objects.add(object::interpolation_exponent, Access::read_write, Mappable::no, -3, {-6, 0});
}

std::vector<DefaultPdo> drive_pdos(bool has_event_timer) {
  std::vector<DefaultPdo> pdos;
  const auto add = [&](PdoDirection direction, std::uint8_t number, std::vector<canopen::MappedObject> mapped) {
    pdos.push_back(
        {.pdo = {direction, number, 255, std::move(mapped)}, .valid = number == 1, .has_event_timer = has_event_timer});
  };
  add(PdoDirection::receive, 1, {object::controlword});
  add(PdoDirection::receive, 2, {object::controlword, object::mode});
  add(PdoDirection::receive, 3, {object::controlword, object::target_position});
  add(PdoDirection::receive, 4, {object::controlword, object::target_velocity});
  add(PdoDirection::transmit, 1, {object::statusword});
  add(PdoDirection::transmit, 2, {object::statusword, object::mode_display});
  add(PdoDirection::transmit, 3, {object::statusword, object::position_actual});
  add(PdoDirection::transmit, 4, {object::statusword, object::velocity_actual});
  return pdos;
}

std::optional<SdoAbort> check_drive_object(canopen::ObjectAddress at, std::int64_t value) {
  if (at == object::mode.object) {
    for (const DriveMode mode : kModes) {
      if (value == static_cast<int>(mode)) return std::nullopt;
    }
    return SdoAbort::invalid_value;
  }
  if (at == object::quick_stop_option.object)
    return one_of(value, kDisableDrive, kSlowDownRamp, kQuickStopRamp, kSlowDownAndStay, canopen::kQuickStopAndStay);
  if (at == object::abort_connection_option.object)
    return one_of(value, kAbortNoAction, kAbortByFault, kAbortByDisableVoltage, canopen::kAbortByQuickStop);
  if (at == object::fault_reaction_option.object) return one_of(value, kDisableDrive, kSlowDownRamp, kQuickStopRamp);
  if (at == object::homing_method.object && !is_homing_method(value)) return SdoAbort::invalid_value;
  return std::nullopt;
}

}  // namespace kenaf::candrives
