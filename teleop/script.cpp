#include "script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace kenaf::teleop {

namespace {

constexpr double kFirstRepeat_s = 0.4, kRepeat_s = 0.04;  // a keyboard's
constexpr double kNotices_s = 1.0, kLetsGo_s = 0.5;       // a person's
constexpr double kPatience_s = 15;                        // without a status from the robot, or without a robot

constexpr std::array kNames{"time_s",          "x_mm",     "y_mm",    "z_mm",
                            "nose_up_deg",     "roll_deg", "yaw_deg", "track_mmps",
                            "flipper_off_deg", "battery_v"};
constexpr std::array kModes{Mode::no_robot, Mode::emergency_stop, Mode::halted, Mode::ready, Mode::driving};

// Largest distance of a flipper from its ordered angle; infinite until the control process has received the order.
double flippers_off_deg(const Status& status, const Desk& desk) {
  if (status.flipper_order != desk.flipper_order()) return std::numeric_limits<double>::infinity();
  double largest = 0;
  for (std::size_t i = 0; i < kFlipperCount; ++i) {
    if ((status.flippers_commanded >> i & 1) == 0) continue;
    largest = std::max(largest, std::abs(status.commanded_flipper_deg[i] - status.flipper_deg[i]));
  }
  return largest;
}

// nullopt if it was not measured: the 0 in its place is no reading.
std::optional<double> value_of(std::string_view name, const Status& status, const Desk& desk) {
  const auto measured = [&](std::uint32_t field, double value) {
    return (status.fields & field) != 0 ? std::optional(value) : std::nullopt;
  };
  const bool has_pose = (status.fields & kHasPose) != 0;
  if (name == "time_s") return status.robot_time_s;
  if (name == "x_mm") return has_pose ? status.pose_mm[0] : measured(kHasEncoders, status.odometry[0]);
  if (name == "y_mm") return has_pose ? status.pose_mm[1] : measured(kHasEncoders, status.odometry[1]);
  if (name == "z_mm") return measured(kHasPose, status.pose_mm[2]);
  if (name == "nose_up_deg") return measured(kHasPosture, -status.posture_deg[1]);
  if (name == "roll_deg") return measured(kHasPosture, status.posture_deg[0]);
  if (name == "yaw_deg") return measured(kHasEncoders, status.odometry[2]);
  if (name == "track_mmps") return measured(kHasEncoders, (status.track_mmps[kLeft] + status.track_mmps[kRight]) / 2);
  if (name == "flipper_off_deg") return measured(kHasFlippers, flippers_off_deg(status, desk));
  return measured(kHasBattery, status.battery_v);
}

class LineReader {
 public:
  LineReader(std::string_view text, int line) : line_(line) {
    while (!text.empty()) {
      const std::size_t begin = text.find_first_not_of(" \t\r");
      if (begin == std::string_view::npos) break;
      text.remove_prefix(begin);
      const std::size_t end = std::min(text.find_first_of(" \t\r"), text.size());
      words_.push_back(text.substr(0, end));
      text.remove_prefix(end);
    }
  }
  bool at_end() const { return next_ == words_.size(); }
  std::string_view peek() const { return at_end() ? std::string_view() : words_[next_]; }
  std::string_view word(std::string_view what) {
    if (at_end()) fail(fmt::format("{} is missing", what));
    return words_[next_++];
  }
  double number(std::string_view what) {
    const std::string_view text = word(what);
    const auto value = number_of(text);
    if (!value) fail(fmt::format("'{}' is not a number ({})", text, what));
    return *value;
  }
  double seconds(std::string_view what) {
    const double value = number(what);
    if (value < 0 || value > 3600) fail(fmt::format("{} of {} s: 0 to 3600", what, value));
    return value;
  }
  std::string key() {
    const std::string_view key = word("a key");
    if (!action_of_key(key)) fail(fmt::format("the key '{}' has no meaning", key));
    return std::string(key);
  }
  Condition condition() {
    const std::string_view name = word("a condition");
    if (name == "mode") {
      if (word("'is'") != "is") fail("a mode is waited for as 'mode is WORD'");
      const std::string_view mode = word("a mode");
      for (const Mode known : kModes) {
        if (mode == name_of(known)) return {std::string(name), '=', 0, std::string(mode)};
      }
      fail(fmt::format("there is no mode '{}'", mode));
    }
    if (std::ranges::find(kNames, name) == kNames.end()) fail(fmt::format("there is no value '{}'", name));
    const std::string_view comparison = word("'<' or '>'");
    if (comparison != "<" && comparison != ">") fail(fmt::format("'{}' is neither '<' nor '>'", comparison));
    return {std::string(name), comparison[0], number("what to compare with"), {}};
  }
  // "until CONDITION within SECONDS"; the word "until" is read already.
  void until(Step& step) {
    step.until = condition();
    if (word("'within'") != "within") fail("'until CONDITION' goes on with 'within SECONDS'");
    step.within_s = seconds("a limit");
  }
  void end() const {
    if (!at_end()) fail(fmt::format("'{}' is unexpected", words_[next_]));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(fmt::format("line {}: {}", line_, what));
  }
  static std::optional<double> number_of(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
    return is_number ? std::optional(value) : std::nullopt;
  }

 private:
  int line_;
  std::vector<std::string_view> words_;
  std::size_t next_ = 0;
};

Step read_step(LineReader& reader, int line, std::string_view text) {
  // "SECONDS KEY": a key press at a given time.
  Step step{.kind = Step::Kind::press, .line = line};
  if (const auto at = LineReader::number_of(reader.peek())) {
    step.seconds = reader.seconds("a time");
    step.text = reader.key();
    return step;
  }

  // Otherwise a command, each with its own arguments.
  const std::string_view command = reader.word("a command");
  if (command == "press") {
    // "press KEY [TIMES]"
    step.text = reader.key();
    const double times = reader.at_end() ? 1 : reader.number("how often");
    if (times != std::floor(times) || times < 1 || times > 1000) reader.fail("a key is pressed 1 to 1000 times");
    step.times = static_cast<int>(times);
  } else if (command == "hold") {
    // "hold KEY for SECONDS" or "hold KEY until CONDITION within SECONDS"
    step.kind = Step::Kind::hold;
    step.text = reader.key();
    if (!drives(*action_of_key(step.text))) reader.fail(fmt::format("the key '{}' cannot be held", step.text));
    const std::string_view how = reader.word("'for' or 'until'");
    if (how != "for" && how != "until") reader.fail(fmt::format("'{}' is neither 'for' nor 'until'", how));
    if (how == "for") step.seconds = reader.seconds("a time");
    if (how == "until") reader.until(step);
  } else if (command == "wait") {
    // "wait SECONDS" or "wait until CONDITION within SECONDS"
    step.kind = Step::Kind::wait;
    if (reader.peek() == "until") {
      reader.word("'until'");
      reader.until(step);
    } else {
      step.seconds = reader.seconds("a time");
    }
  } else if (command == "say") {
    // "say TEXT": takes the rest of the line verbatim, not word by word.
    step.kind = Step::Kind::say;
    const std::size_t begin = text.find("say") + 3;
    step.text = text.substr(std::min(text.find_first_not_of(" \t", begin), text.size()));
    while (!reader.at_end()) reader.word("");
  } else {
    reader.fail(fmt::format("'{}' is neither press, hold, wait or say nor a time", command));
  }
  return step;
}

std::string words_of(const Condition& condition) {
  if (condition.comparison == '=') return fmt::format("mode is {}", condition.word);
  return fmt::format("{} {} {}", condition.name, condition.comparison, condition.number);
}

}  // namespace

bool holds(const Condition& condition, const Status& status, const Desk& desk) {
  if (condition.comparison == '=') return name_of(status.mode) == condition.word;
  const std::optional<double> value = value_of(condition.name, status, desk);
  if (!value) return false;
  return condition.comparison == '>' ? *value > condition.number : *value < condition.number;
}

Script read_script(std::string_view text) {
  Script script;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view content = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    LineReader reader(content, line);
    if (reader.at_end() || reader.peek().front() == '#') continue;
    script.push_back(read_step(reader, line, content));
    reader.end();
  }
  return script;
}

void Player::begin_step(double now_s) {
  step_began_s_ = now_s;
  step_began_robot_s_.reset();
  no_robot_since_s_.reset();
  next_press_s_.reset();
  halt_seen_s_.reset();
}

// Releases and presses again after a halt of the robot. Otherwise the key repeats.
void Player::press_held(Action action, double now_s, const Status* newest, Turn& turn) {
  const bool waits = newest != nullptr && newest->mode == Mode::halted;
  if (!waits) halt_seen_s_.reset();
  if (waits && !halt_seen_s_) halt_seen_s_ = now_s;
  if (halt_seen_s_ && now_s >= *halt_seen_s_ + kNotices_s) {
    if (now_s < *halt_seen_s_ + kNotices_s + kLetsGo_s) {
      next_press_s_.reset();
      return;
    }
    halt_seen_s_ = now_s;  // pressed again below; the operator looks again
  }
  if (next_press_s_ && now_s < *next_press_s_) return;
  next_press_s_ = now_s + (next_press_s_ ? kRepeat_s : kFirstRepeat_s);
  turn.pressed.push_back(action);
}

Player::Turn Player::turn(double now_s, const Status* newest, double silent_s, const Desk& desk) {
  Turn turn;
  if (script_began_s_ < 0) {
    script_began_s_ = now_s;
    begin_step(now_s);
  }
  while (step_ < script_.size()) {
    const Step& step = script_[step_];
    // What was pressed is acted on after this turn; a condition asked in it would still see what was before.
    const auto end_step = [&] {
      ++step_;
      begin_step(now_s);
      turn.finished = step_ == script_.size();
    };
    const auto fail = [&](const std::string& why) {
      turn.failed = fmt::format("line {}: {}", step.line, why);
      turn.finished = true;
    };
    if (step.kind == Step::Kind::say) {
      turn.said.push_back(step.text);
    } else if (step.kind == Step::Kind::press) {
      if (now_s < script_began_s_ + step.seconds) return turn;
      for (int i = 0; i < step.times; ++i) turn.pressed.push_back(*action_of_key(step.text));
      end_step();
      return turn;
    } else if (step.until) {
      // A robot that was opened anew begins its time anew.
      if (newest != nullptr) {
        step_began_robot_s_ = std::min(step_began_robot_s_.value_or(newest->robot_time_s), newest->robot_time_s);
      }
      const bool has_robot = newest == nullptr || newest->mode != Mode::no_robot;
      if (has_robot) no_robot_since_s_.reset();
      if (!has_robot && !no_robot_since_s_) no_robot_since_s_ = now_s;
      const bool is_seen = newest != nullptr && holds(*step.until, *newest, desk);
      if (!is_seen) {
        if (newest != nullptr && newest->robot_time_s - *step_began_robot_s_ > step.within_s) {
          fail(fmt::format("'{}' was not seen within {} s of the robot's time", words_of(*step.until), step.within_s));
          return turn;
        }
        // Its time stands meanwhile, and would never come to an end.
        const double without_s = std::max(step.within_s, kPatience_s);
        if (no_robot_since_s_ && now_s - *no_robot_since_s_ > without_s) {
          fail(fmt::format("'{}' was not seen, and there was no robot for {} s: {}", words_of(*step.until), without_s,
                           view(newest->message)));
          return turn;
        }
        if ((newest == nullptr ? now_s - step_began_s_ : silent_s) > kPatience_s) {
          fail(fmt::format("no message from the robot for {} s", kPatience_s));
          return turn;
        }
        if (step.kind == Step::Kind::hold) press_held(*action_of_key(step.text), now_s, newest, turn);
        return turn;
      }
      if (step.kind == Step::Kind::hold) {
        turn.pressed.push_back(Action::stand);  // release
        end_step();
        return turn;
      }
    } else if (now_s < step_began_s_ + step.seconds) {
      if (step.kind == Step::Kind::hold) press_held(*action_of_key(step.text), now_s, newest, turn);
      return turn;
    } else if (step.kind == Step::Kind::hold) {
      turn.pressed.push_back(Action::stand);
      end_step();
      return turn;
    }
    end_step();
  }
  turn.finished = true;
  return turn;
}

}  // namespace kenaf::teleop
