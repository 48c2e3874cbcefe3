#include "can/candrives/drive.hpp"

#include <algorithm>
#include <cmath>

#include "can/candrives/drive_objects.hpp"
#include "can/canopen/device.hpp"

namespace kenaf::candrives {

using canopen::DriveMode;
using canopen::ObjectAddress;
using canopen::PowerState;
using canopen::Time;

namespace {

// CiA 402-2, device type: bit 17, a servo drive.
constexpr std::uint32_t kServoDrive = 0x00020000 | canopen::kProfileDrive;

DeviceIdentity identity(const DriveSetup& setup) {
  return {.device_type = kServoDrive,
          .name = "Kenaf simulated drive: " + setup.name,
          .product_code = canopen::kProfileDrive,
          .revision = 1,
          .serial_number = setup.node};
}

std::int64_t limited(double value, canopen::ObjectType type) {
  const ObjectLimits range = range_of(type);
  return std::llround(std::clamp(value, static_cast<double>(range.min), static_cast<double>(range.max)));
}

}  // namespace

Drive::Drive(const DriveSetup& setup, const Measured& motor)
    : Slave(setup.node, identity(setup), drive_pdos(setup.has_event_timer)),
      setup_(setup),
      motor_(motor),
      motion_(objects(), setup.scale) {
  add_drive_objects(dictionary(), {setup.has_current, setup.has_voltage});
  on_reset();
}

// Also after a node reset while the motor turned: without power its brake holds it.
void Drive::on_reset() {
  power_.reset();
  error_code_ = 0;
  outside_window_s_ = 0;
  motion_.reset(motor_, setup_.absolute_encoder ? 0 : -std::llround(motor_.position));
  on_quirks();
}

// Values as a maker's tool or an earlier master left them.
void Drive::on_quirks() {
  constexpr std::int64_t kOldTarget = 20'000;
  if (quirks().halt_blocks_mode) dictionary().set(object::controlword.object, canopen::kControlHalt);
  if (quirks().old_target && power_.state() != PowerState::operation_enabled)
    dictionary().set(object::target_velocity.object, kOldTarget);
  motion_.set_home_offset_direction(quirks().home_offset_negative ? -1 : setup_.scale.home_offset_direction);
}

bool Drive::lacks(ObjectAddress at) const {
  const bool is_current = at == object::current_actual.object || at == object::rated_current.object;
  return (quirks().no_current && is_current) || (quirks().no_voltage && at == object::dc_link_voltage.object);
}

void Drive::watch_slow_reset(double step_s) {
  const bool high = (option(object::controlword) & canopen::kControlFaultReset) != 0;
  reset_bit_s_ = quirks().slow_fault_reset && high && power_.state() == PowerState::fault ? reset_bit_s_ + step_s : 0;
  if (reset_bit_s_ * 1e9 < static_cast<double>(kSlowReset.count())) return;
  power_.on_controlword(canopen::kControlFaultReset);
  errors().clear(std::exchange(error_code_, std::uint16_t{0}));
}

void Drive::step(Time step) {
  const double step_s = std::chrono::duration<double>(step).count();
  // The self-test takes one step; a newly written mode takes effect now.
  power_.self_test_passed();
  watch_slow_reset(step_s);
  motion_.set_mode(static_cast<DriveMode>(option(object::mode)), motor_);

  // By state: follow the targets, stop on the ramp that an option code names, or hold.
  switch (power_.state()) {
    case PowerState::operation_enabled:
      motion_.operate(motor_, step_s);
      return watch_following(step_s);
    case PowerState::quick_stop_active: {
      // Codes 1 and 5 stop on the profile ramp, the others on the quick stop ramp; 1 and 2 then switch the drive off.
      const std::int64_t code = option(object::quick_stop_option);
      const bool by_profile = code == kSlowDownRamp || code == kSlowDownAndStay;
      const bool stands = motion_.slow_down(by_profile ? SlowDown::profile_ramp : SlowDown::quick_stop_ramp, step_s);
      if (stands && (code == kSlowDownRamp || code == kQuickStopRamp)) power_.disable_voltage();
      return;
    }
    case PowerState::fault_reaction_active: {
      const bool by_profile = option(object::fault_reaction_option) == kSlowDownRamp;
      if (motion_.slow_down(by_profile ? SlowDown::profile_ramp : SlowDown::quick_stop_ramp, step_s))
        power_.reaction_done();
      return;
    }
    default:
      return motion_.hold();
  }
}

void Drive::watch_following(double step_s) {
  outside_window_s_ = motion_.is_outside_window(motor_) ? outside_window_s_ + step_s : 0;
  if (outside_window_s_ * 1000 > static_cast<double>(option(object::following_error_timeout_ms)))
    fail(canopen::kErrorFollowing);
}

bool Drive::holds_position() const {
  return !is_powered() || canopen::is_position(motion_.mode()) || motion_.mode() == DriveMode::homing;
}

void Drive::fail(std::uint16_t error_code) {
  const bool already = power_.state() == PowerState::fault || power_.state() == PowerState::fault_reaction_active;
  if (already) return;
  const bool was_powered = power_.is_powered();
  error_code_ = error_code;
  errors().raise(error_code);
  power_.fault();
  if (!was_powered || option(object::fault_reaction_option) == kDisableDrive) power_.reaction_done();
}

// ---- objects ----

void Drive::refresh() {
  Dictionary& values = dictionary();
  std::uint16_t status = canopen::kStatusRemote | canopen::kStatusVoltageEnabled | power_.statusword_bits();
  if (power_.state() == PowerState::operation_enabled) status |= motion_.statusword_bits(motor_);
  if (power_.state() == PowerState::quick_stop_active && motion_.demand().velocity == 0)
    status |= canopen::kStatusTargetReached;
  if (error_code_ == canopen::kErrorFollowing) status |= canopen::kStatusError;
  values.set(object::statusword.object, status);
  values.set(object::error_code.object, error_code_);
  values.set(object::mode_display.object, static_cast<int>(motion_.mode()));
  const std::int64_t counters = std::int64_t{1} << quirks().position_bits;
  const std::int64_t position = motion_.position(motor_);
  values.set(object::position_actual.object, quirks().position_bits < 32 ? position & (counters - 1) : position);
  std::int64_t velocity =
      limited(motor_.velocity / setup_.scale.counts_per_velocity_unit, object::velocity_actual.type);
  if (quirks().velocity_unsigned) velocity = std::abs(velocity);
  if (quirks().velocity_16_bits) velocity &= 0xffff;
  values.set(object::velocity_actual.object, velocity);
  if (setup_.has_current)
    values.set(object::current_actual.object,
               limited(motor_.current_a * 1e6 / static_cast<double>(option(object::rated_current)),
                       object::current_actual.type));
  if (setup_.has_voltage)
    values.set(object::dc_link_voltage.object, limited(motor_.supply_v * 1000, object::dc_link_voltage.type));
  values.set(object::following_error.object,
             limited(motion_.demand().position - motor_.position, object::following_error.type));
}

std::optional<canopen::SdoAbort> Drive::check_write(ObjectAddress at, std::int64_t value) {
  const bool enabled = power_.state() == PowerState::operation_enabled;
  if (at == object::mode.object) {
    const bool halted = (option(object::controlword) & canopen::kControlHalt) != 0;
    if ((quirks().mode_locked && enabled) || (quirks().halt_blocks_mode && halted))
      return canopen::SdoAbort::not_in_this_state;
  }
  if (at == object::target_velocity.object && quirks().old_target && takes_pdo() && !enabled)
    return canopen::SdoAbort::not_in_this_state;
  return check_drive_object(at, value);
}

void Drive::on_write(ObjectAddress at, std::int64_t value) {
  if (at == object::controlword.object && !deaf_) on_controlword(static_cast<std::uint16_t>(value));
  if (at == object::target_position.object) motion_.on_target_position();
}

void Drive::on_controlword(std::uint16_t controlword) {
  const PowerState before = power_.state();
  if (before == PowerState::fault && quirks().slow_fault_reset) return;  // watch_slow_reset
  power_.on_controlword(controlword);
  const PowerState after = power_.state();
  const bool enabled = after == PowerState::operation_enabled;
  if (enabled && before != after) {
    outside_window_s_ = 0;
    motion_.set_mode(static_cast<DriveMode>(option(object::mode)), motor_);
    motion_.begin(motor_);
  }
  motion_.on_controlword(controlword, enabled, motor_);
  if (after == PowerState::quick_stop_active && before == PowerState::operation_enabled) begin_quick_stop();
  if (before == PowerState::fault && after != before) {
    errors().clear(error_code_);
    error_code_ = 0;
  }
}

void Drive::begin_quick_stop() {
  if (option(object::quick_stop_option) == kDisableDrive) power_.disable_voltage();
}

void Drive::on_connection_lost(std::uint16_t error_code) {
  if (quirks().missing_commands_fault && error_code == canopen::kErrorPdoTimeOut && power_.is_powered())
    return fail(error_code);
  if (power_.state() != PowerState::operation_enabled) return;
  switch (option(object::abort_connection_option)) {
    case kAbortByFault:
      return fail(error_code);
    case kAbortByDisableVoltage:
      return power_.disable_voltage();
    case canopen::kAbortByQuickStop:
      power_.quick_stop();
      return begin_quick_stop();
    default:
      return;
  }
}

}  // namespace kenaf::candrives
