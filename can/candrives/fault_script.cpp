#include "can/candrives/fault_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>

namespace kenaf::candrives {

using canopen::NodeId;
using canopen::Time;

namespace {

struct Named {
  std::string_view words;
  FaultKind kind;
};
constexpr std::array kKinds = std::to_array<Named>({{"silent", FaultKind::silent},
                                                    {"power loss", FaultKind::power_loss},
                                                    {"fault", FaultKind::error},
                                                    {"following error", FaultKind::following_error},
                                                    {"deaf", FaultKind::deaf},
                                                    {"no heartbeat watch", FaultKind::no_heartbeat},
                                                    {"no event timer", FaultKind::no_event_timer},
                                                    {"sdo abort", FaultKind::sdo_abort},
                                                    {"sdo late", FaultKind::sdo_late},
                                                    {"sdo wrong toggle", FaultKind::sdo_wrong_toggle},
                                                    {"short pdos", FaultKind::short_pdos},
                                                    {"garbage", FaultKind::garbage},
                                                    {"sdo garbage", FaultKind::sdo_garbage},
                                                    {"slow boot", FaultKind::slow_boot},
                                                    {"node guarding only", FaultKind::guarding_only},
                                                    {"count first", FaultKind::count_first},
                                                    {"fixed mapping", FaultKind::fixed_mapping},
                                                    {"first rpdo fixed", FaultKind::first_rpdo_fixed},
                                                    {"slow commands", FaultKind::slow_commands},
                                                    {"mode locked", FaultKind::mode_locked},
                                                    {"halt blocks mode", FaultKind::halt_blocks_mode},
                                                    {"old target", FaultKind::old_target},
                                                    {"slow fault reset", FaultKind::slow_fault_reset},
                                                    {"velocity unsigned", FaultKind::velocity_unsigned},
                                                    {"velocity 16 bits", FaultKind::velocity_16_bits},
                                                    {"position 16 bits", FaultKind::position_16_bits},
                                                    {"position 24 bits", FaultKind::position_24_bits},
                                                    {"no current", FaultKind::no_current},
                                                    {"no voltage", FaultKind::no_voltage},
                                                    {"home offset negative", FaultKind::home_offset_negative},
                                                    {"missing commands fault", FaultKind::missing_commands_fault},
                                                    {"healed", FaultKind::healed}});

constexpr std::string_view kBlanks = " \t\r";

// The words of a line, consumed one after another.
class Line {
 public:
  explicit Line(std::string_view text) : text_(text), rest_(text) { skip_blanks(); }
  bool empty() const { return rest_.empty(); }

  // Consumes `words` if they are next.
  bool take(std::string_view words) {
    if (!rest_.starts_with(words)) return false;
    if (rest_.size() > words.size() && kBlanks.find(rest_[words.size()]) == kBlanks.npos) return false;
    rest_.remove_prefix(words.size());
    skip_blanks();
    return true;
  }
  std::string_view next() {
    const std::string_view word = rest_.substr(0, rest_.find_first_of(kBlanks));
    rest_.remove_prefix(word.size());
    skip_blanks();
    return word;
  }
  [[noreturn]] void fail(const std::string& expected) const {
    throw std::invalid_argument(fmt::format("fault '{}': {}", text_, expected));
  }

 private:
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size())); }

  std::string_view text_, rest_;
};

std::uint32_t take_number(Line& line, std::string_view what, std::uint32_t max) {
  std::string_view word = line.next();
  const bool is_hexadecimal = word.starts_with("0x");
  if (is_hexadecimal) word.remove_prefix(2);
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(word.begin(), word.end(), number, is_hexadecimal ? 16 : 10);
  if (error != std::errc() || end != word.end() || number == 0 || number > max)
    line.fail(fmt::format("{} must be a number from 1 to {}", what, max));
  return number;
}

Time take_seconds(Line& line, std::string_view after) {
  const std::string word(line.next());
  double seconds = -1;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), seconds);
  if (error != std::errc() || end != word.data() + word.size() || !(seconds >= 0) || seconds > 1e6)
    line.fail(fmt::format("{} there must be seconds", after));
  return std::chrono::duration_cast<Time>(std::chrono::duration<double>(seconds));
}

std::vector<NodeId> nodes_of(const canbus::RobotBus& bus) {
  std::vector<NodeId> nodes;
  for (const auto& drive : bus.drives) nodes.push_back(drive.node);
  if (bus.inclinometer) nodes.push_back(bus.inclinometer->node);
  if (bus.gyro) nodes.push_back(bus.gyro->node);
  return nodes;
}

NodeId take_node(Line& line, const canbus::RobotBus& bus) {
  if (line.take("all") || line.take("bus")) return 0;
  if (line.take("inclinometer")) {
    if (!bus.inclinometer) line.fail("this robot has no inclinometer on its bus");
    return bus.inclinometer->node;
  }
  if (line.take("gyro")) {
    if (!bus.gyro) line.fail("this robot has no gyro on its bus");
    return bus.gyro->node;
  }
  std::vector<std::string_view> names;
  for (const canbus::DriveOnBus& drive : bus.drives) {
    if (line.take(drive.name)) return drive.node;
    names.push_back(drive.name);
  }
  if (!line.take("node"))
    line.fail(
        fmt::format("it must begin with node NUMBER, {}, inclinometer, gyro, all or bus", fmt::join(names, ", ")));
  const std::vector<NodeId> nodes = nodes_of(bus);
  const auto node = static_cast<NodeId>(take_number(line, "a node", canopen::kMaxNode));
  if (!std::ranges::count(nodes, node))
    line.fail(fmt::format("the robot's nodes are {}, not {}", fmt::join(nodes, ", "), node));
  return node;
}

FaultKind take_kind(Line& line) {
  for (const Named& named : kKinds) {
    if (line.take(named.words)) return named.kind;
  }
  std::vector<std::string_view> words;
  for (const Named& named : kKinds) words.push_back(named.words);
  line.fail(fmt::format("it must name one of {}", fmt::join(words, ", ")));
}

}  // namespace

PlannedFault parse_fault(std::string_view words, const canbus::RobotBus& bus) {
  // WHO WHAT, with a code if the kind takes one.
  Line line(words);
  PlannedFault planned;
  planned.fault.node = take_node(line, bus);
  planned.fault.kind = take_kind(line);
  if (planned.fault.kind == FaultKind::error)
    planned.fault.error_code = static_cast<std::uint16_t>(take_number(line, "an error code", 0xffff));

  // When: "at SECONDS", now (the line ends or goes on with "for"), or "SECONDS after motion".
  const auto take_lasting = [&] {
    if (!line.take("for")) return false;
    planned.lasts = take_seconds(line, "after 'for'");
    return true;
  };
  if (line.take("at")) {
    planned.delay = take_seconds(line, "after 'at'");
  } else if (line.empty() || take_lasting()) {
    planned.at_once = true;
  } else {
    planned.delay = take_seconds(line, "before 'after motion'");
    if (!line.take("after motion")) line.fail("after the seconds there must be 'after motion'");
    planned.after_motion = true;
  }

  // Duration; any remaining words are an error.
  take_lasting();
  if (!line.empty()) line.fail("'" + std::string(line.next()) + "' is not understood");
  return planned;
}

void FaultScript::add(const PlannedFault& planned, Time now) {
  if (planned.at_once)
    timed_.push_back({now, planned});
  else if (!planned.after_motion)
    timed_.push_back({start_ + planned.delay, planned});
  else if (motion_)
    timed_.push_back({*motion_ + planned.delay, planned});
  else
    waiting_for_motion_.push_back(planned);
}

void FaultScript::on_motion(Time now) {
  if (motion_) return;
  motion_ = now;
  for (const PlannedFault& planned : waiting_for_motion_) timed_.push_back({now + planned.delay, planned});
  waiting_for_motion_.clear();
}

std::vector<Fault> FaultScript::due(Time now) {
  std::vector<Fault> faults;
  std::vector<Entry> healings;
  std::erase_if(timed_, [&](const Entry& entry) {
    if (entry.at > now) return false;
    faults.push_back(entry.planned.fault);
    if (entry.planned.lasts)
      healings.push_back(
          {entry.at + *entry.planned.lasts, {{FaultKind::healed, entry.planned.fault.node}, {}, {}, {}, {}}});
    return true;
  });
  timed_.insert(timed_.end(), healings.begin(), healings.end());
  return faults;
}

Time FaultScript::deadline() const {
  Time next = Time::max();
  for (const Entry& entry : timed_) next = std::min(next, entry.at);
  return next;
}

}  // namespace kenaf::candrives
