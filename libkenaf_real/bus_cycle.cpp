#include "libkenaf_real/bus_cycle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hrt/error.hpp"
#include "libkenaf_real/commissioning.hpp"

namespace kenaf::real {
namespace {

using canopen::PowerState;
using canopen::Time;
using hrt::Error;

// Share of a period for the answers; the rest is for the commands to the drives.
constexpr double kAnswerShare = 0.6;
// Maximum bus load; the rest is for retransmissions after errors, and so that SYNC finds the bus free.
constexpr double kMostLoad = 0.7;
// Two lost frames of a drive do not count as silence: kSilentDrive_s spans two and a half of these.
constexpr double kLongestPeriod_s = 0.02;
// The kernel sends SYNC: this long without one means that the interface is gone.
constexpr Time kLongestSync = std::chrono::milliseconds(100);

double seconds(Time duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

void check_period(const canbus::RobotBus& bus, double period_s) {
  if (period_s > kLongestPeriod_s) {
    throw Error(HRT_E_CONFIG,
                fmt::format("period_s is {}, but must be at most {} with this library: a drive that is silent is to be "
                            "noticed after {} s",
                            period_s, kLongestPeriod_s, kSilentDrive_s));
  }
  const double share = canbus::worst_case_bits_per_s(bus, period_s) / bus.bit_rate;
  if (share <= kMostLoad) return;
  throw Error(HRT_E_CONFIG,
              fmt::format("period_s is {}: so short a cycle can fill {:.0f} % of {} bits a second (can.bit_rate of the "
                          "robot's description), and must not fill more than {:.0f} %",
                          period_s, 100 * share, bus.bit_rate, 100 * kMostLoad));
}

BusCycle::BusCycle(Master& master, const canbus::RobotBus& bus, double period_s)
    : master_(master),
      bus_(bus),
      period_(to_time(period_s)),
      image_(bus),
      sent_(bus.drives.size()),
      sent_at_(bus.drives.size()) {
  for (std::size_t i = 0; i < bus.drives.size(); ++i) pdos_.push_back(canbus::pdos_of(bus, i));
  master_.watch([this](const canopen::ReceivedFrame& frame) { image_.on_frame(frame); });
}

BusCycle::~BusCycle() {
  master_.watch({});
}

void BusCycle::start() {
  master_.bus().start_sync(period_);
}

void BusCycle::stop() {
  master_.bus().stop_sync();
}

std::optional<Beat> BusCycle::wait() {
  const auto is_new = [this] { return image_.sync_at() && image_.sync_at() != answered_sync_at_; };
  if (!master_.wait_until(master_.now() + kLongestSync, is_new)) {
    if (master_.was_interrupted()) return std::nullopt;
    throw Error(HRT_E_LINK,
                fmt::format("no SYNC on {} any more: is the interface still up? (`ip -details link show {}`)",
                            bus_.interface, bus_.interface));
  }
  // After a hold-up several SYNCs wait in the socket: answers to all of them would be taken within one period.
  while (master_.now() - *image_.sync_at() >= period_ && master_.receive(master_.now())) {
  }
  const Time answers_until = *image_.sync_at() + std::chrono::round<Time>(kAnswerShare * period_);
  if (master_.wait_until(answers_until, [this] { return image_.is_complete(); })) {
    round_trip_s_ = seconds(master_.now() - *image_.sync_at());
  } else if (master_.was_interrupted()) {
    return std::nullopt;
  }
  // a later SYNC may have arrived meanwhile; the newest counts
  const Time at = *image_.sync_at();
  if (!first_sync_at_) first_sync_at_ = at;
  const auto on_grid = 1 + std::lround(seconds(at - *first_sync_at_) / seconds(period_));
  number_ = std::max(number_ + 1, static_cast<std::uint32_t>(on_grid));
  answered_sync_at_ = at;
  return Beat{number_, at};
}

double BusCycle::period_s() const {
  return seconds(period_);
}

void BusCycle::send(const DriveOrders& orders) {
  send(orders, false);
}

void BusCycle::send_at_once(const DriveOrders& orders) {
  send(orders, true);
}

void BusCycle::send(const DriveOrders& orders, bool at_once) {
  master_.check_pause();
  for (std::size_t i = 0; i < orders.size(); ++i) {
    // In SYNCs, as the drive counts them: two orders in one cycle, the loop's last and a stop, are two too many.
    const int every = bus_.drives[i].device.command_every;
    const bool has_turn = every == 1 || !sent_at_[i] || number_ - *sent_at_[i] >= static_cast<std::uint32_t>(every);
    // One quick stop stops a drive: repeated ones, which are for lost frames, have time.
    const bool is_first_stop =
        orders[i].controlword == canopen::kControlQuickStop && sent_[i].controlword != canopen::kControlQuickStop;
    if (!has_turn && !(at_once && is_first_stop)) continue;
    sent_at_[i] = number_;
    const std::array<std::int64_t, 2> values{orders[i].controlword, orders[i].target};
    master_.send(pack(pdos_[i].command, bus_.drives[i].node, values));
    sent_[i] = orders[i];
  }
  if (answered_sync_at_ && master_.now() > *answered_sync_at_ + period_) ++late_;
}

// Measured by the newest SYNC, not by the clock: a master that was held up finds the answers waiting, with their times
// of arrival.
bool BusCycle::is_silent(const std::optional<Time>& at, double limit_s) const {
  return !at || (image_.sync_at() && *image_.sync_at() - *at > to_time(limit_s));
}

std::optional<std::size_t> BusCycle::lost_drive() const {
  for (std::size_t i = 0; i < bus_.drives.size(); ++i) {
    const DriveInput& drive = image_.drive(i);
    if (drive.restarted || drive.jump != 0 || is_silent(drive.state_at, kSilentDrive_s) ||
        canopen::power_state_of(drive.statusword) != PowerState::operation_enabled)
      return i;
  }
  return std::nullopt;
}

std::string BusCycle::loss_of(std::size_t i) const {
  const DriveInput& drive = image_.drive(i);
  const std::string name = to_string(drive_node(bus_, i));
  if (drive.restarted) return fmt::format("{} has restarted: was its supply interrupted?", name);
  if (drive.jump != 0) {
    return fmt::format("the position of {} (object 0x6064) jumped by {} counts, farther than the drive can turn{}",
                       name, drive.jump, canbus::advice(bus_.drives[i].device, "position_bits = 16 (or 24)"));
  }
  if (!drive.state_at) return fmt::format("{} sends no process data", name);
  if (is_silent(drive.state_at, kSilentDrive_s))
    return fmt::format("{} has been silent for {:.2f} s", name, seconds(*image_.sync_at() - *drive.state_at));
  return fmt::format("{} is not enabled any more: its state is \"{}\" (statusword {:#06x})", name,
                     describe(canopen::power_state_of(drive.statusword)), drive.statusword);
}

std::string BusCycle::emergency_of(std::size_t i) const {
  const DriveInput& drive = image_.drive(i);
  return drive.emergency ? describe(*drive.emergency) : std::string();
}

bool BusCycle::slope_is_silent() const {
  return bus_.inclinometer && is_silent(image_.slope().at, kSilentSensor_s);
}

bool BusCycle::gyro_is_silent() const {
  return bus_.gyro && is_silent(image_.gyro().at, kSilentSensor_s);
}

}  // namespace kenaf::real
