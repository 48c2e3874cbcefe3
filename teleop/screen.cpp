#include "screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kenaf::teleop {

namespace {

constexpr double kSilent_s = 0.5;  // a pause of this length without a status is shown as silence

// Nominal dimensions of the robot, for the drawing only: pivots, flippers, height of body and belts.
constexpr double kPivotX_mm = 225, kFlipper_mm = 145, kBodyTop_mm = 90, kBelly_mm = -90, kPivotZ_mm = -25;
constexpr double kColumn_mm = 30, kRow_mm = 60;  // a character is about twice as high as wide
constexpr std::size_t kPostureRows = 9, kPostureColumns = 38;

struct Point {
  double x_mm, z_mm;
};

// Draws into the posture field; the body is at its centre.
class SideView {
 public:
  SideView(Canvas& canvas, std::size_t row, std::size_t column, double nose_up_rad, std::size_t scale)
      : canvas_(canvas),
        row_(row),
        column_(column),
        rows_(kPostureRows * scale),
        columns_(kPostureColumns * scale),
        column_mm_(kColumn_mm / static_cast<double>(scale)),
        row_mm_(kRow_mm / static_cast<double>(scale)),
        cos_(std::cos(nose_up_rad)),
        sin_(std::sin(nose_up_rad)) {}

  void line(Point from, Point to, Tone tone) {
    const Point a = turned(from), b = turned(to);
    const double steps = std::max(std::abs(b.x_mm - a.x_mm) / column_mm_, std::abs(b.z_mm - a.z_mm) / row_mm_);
    const auto count = std::max(1, static_cast<int>(std::ceil(steps)));
    const char character = stroke(b.x_mm - a.x_mm, b.z_mm - a.z_mm);
    for (int i = 0; i <= count; ++i) {
      const double share = static_cast<double>(i) / count;
      put(std::lerp(a.x_mm, b.x_mm, share), std::lerp(a.z_mm, b.z_mm, share), character, tone);
    }
  }
  void dot(Point point, char character, Tone tone) {
    const Point p = turned(point);
    put(p.x_mm, p.z_mm, character, tone);
  }

 private:
  Point turned(Point p) const { return {cos_ * p.x_mm - sin_ * p.z_mm, sin_ * p.x_mm + cos_ * p.z_mm}; }
  static char stroke(double dx_mm, double dz_mm) {
    // the slopes that characters can show are 0, 2 and infinite
    const double steep = std::abs(dz_mm) / std::max(1e-9, std::abs(dx_mm));
    if (steep < 0.7) return '-';
    if (steep > 5) return '|';
    return dx_mm * dz_mm > 0 ? '/' : '\\';
  }
  void put(double x_mm, double z_mm, char character, Tone tone) {
    const auto column = static_cast<int>(std::lround(x_mm / column_mm_)) + static_cast<int>(columns_ / 2);
    const auto row = static_cast<int>(rows_ / 2) - static_cast<int>(std::lround(z_mm / row_mm_));
    if (column < 0 || column >= static_cast<int>(columns_) || row < 0 || row >= static_cast<int>(rows_)) {
      return;
    }
    canvas_.put(row_ + static_cast<std::size_t>(row), column_ + static_cast<std::size_t>(column),
                std::string_view(&character, 1), tone);
  }

  Canvas& canvas_;
  std::size_t row_, column_, rows_, columns_;
  double column_mm_, row_mm_, cos_, sin_;
};

Tone tone_of(Mode mode) {
  switch (mode) {
    case Mode::driving:
    case Mode::ready:
      return Tone::good;
    case Mode::halted:
      return Tone::warning;
    default:
      return Tone::alarm;
  }
}

std::string words_of(const Status& status) {
  // The mode says it all but for a halt, for which the reason says how it ends.
  switch (status.mode) {
    case Mode::no_robot:
      return "NO ROBOT";
    case Mode::emergency_stop:
      return "EMERGENCY STOP - X releases it";
    case Mode::ready:
      return "READY - hold a key to drive";
    case Mode::driving:
      return "DRIVING";
    case Mode::halted:
      break;
  }
  switch (status.halt) {
    case Halt::start:
      return "HALTED at the start - let go of all keys";
    case Halt::silence:
      return "HALTED by silence of this console - let go, then press again";
    case Halt::robot_lost:
      return "HALTED, the robot's link was reopened - let go, then press";
    case Halt::emergency:
      return "HALTED after the emergency stop - let go of all keys";
    case Halt::late:
      return "HALTED, this link is too slow: what you see is old - let go, then press";
  }
  return "";
}

// A rounded 0 has no sign.
std::string number(double value, int digits) {
  std::string text = fmt::format("{:.{}f}", value, digits);
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

// An angle with its side in words: "5.0 left".
std::string to_side(double value, int digits, std::string_view plus, std::string_view minus) {
  const std::string size = number(std::abs(value), digits);
  return size.find_first_not_of("0.") == std::string::npos ? size
                                                           : fmt::format("{} {}", size, value > 0 ? plus : minus);
}

std::string figure(bool has, double value, int digits) {
  return has ? number(value, digits) : "-";
}

std::string measured(bool has, double value, int digits) {
  return fmt::format("{:>7}", figure(has, value, digits));
}

template <std::size_t n>
std::string measured(bool has, const std::array<double, n>& values, int digits) {
  std::string out;
  for (const double value : values) out += measured(has, value, digits);
  return out;
}

// Where each part begins. In the compact form the link has the first row, and there are no rules.
struct Form {
  bool full;
  std::size_t link, robot, figures, figures_column, place, desk, help;
};

Form form_of(std::size_t rows, std::size_t columns) {
  if (rows < kRows || columns < kColumns) return {false, 0, 1, 3, 1, 12, 14, 16};
  const std::size_t more = rows - kRows;
  return {true, 1, 2, 5, columns - 40, 14 + more, 16 + more, 20 + more};
}

void draw_rule(Canvas& canvas, std::size_t row) {
  canvas.put(row, 0, std::string(canvas.columns(), '-'), Tone::dim);
}

void draw_link(Canvas& canvas, const View& view, const Form& form) {
  const std::optional<double> silence_s = view.health.silence_s(view.now_s);
  canvas.put(form.link, 1, "link");
  if (view.taken) {
    canvas.put(form.link, 8, fmt::format("TAKEN: {}", *view.taken), Tone::alarm);
  } else if (!silence_s) {
    canvas.put(form.link, 8, "nothing heard yet", Tone::alarm);
  } else if (*silence_s > kSilent_s) {
    canvas.put(form.link, 8, fmt::format("SILENT for {:.1f} s: the values below are old", *silence_s), Tone::alarm);
  } else {
    const double up = view.health.loss_up_percent(), down = view.health.loss_down_percent();
    const double round_trip_ms = 1e3 * view.health.round_trip_s().value_or(0);
    canvas.put(form.link, 8, "ok", Tone::good);
    canvas.put(form.link, 12,
               form.full ? fmt::format("round trip {:3.0f} ms   lost up {:.0f} %  down {:.0f} %   heard {:.2f} s ago",
                                       round_trip_ms, up, down, *silence_s)
                         : fmt::format("{:.0f} ms  lost {:.0f}/{:.0f} %  heard {:.2f} s ago", round_trip_ms, up, down,
                                       *silence_s),
               up > 20 || down > 20 ? Tone::warning : Tone::plain);
  }
}

void draw_state(Canvas& canvas, const Status& status, const Form& form) {
  canvas.put(form.robot, 1, "robot");
  canvas.put(form.robot, 8, words_of(status), tone_of(status.mode));
  std::string notes = (status.flags & kSimulated) != 0 ? "simulated" : "real";
  if ((status.flags & kPaused) != 0) notes += ", PAUSED";
  if ((status.flags & kStoppedBySilence) != 0) notes += ", STOPPED: control too slow";
  if ((status.flags & kRecording) != 0) notes += ", recording";
  notes += fmt::format("   time {:.1f} s", status.robot_time_s);
  if (form.full) {
    notes += fmt::format("   round trip {:.1f} ms   late cycles {}", status.robot_round_trip_ms, status.late_cycles);
  }
  canvas.put(form.robot + 1, 8, notes, Tone::dim);
}

void draw_measured(Canvas& canvas, const Status& status, const Wish& wish, const Form& form) {
  const auto has = [&](std::uint32_t field) { return (status.fields & field) != 0; };
  std::size_t row = form.figures;
  const auto put = [&](const std::string& text, Tone tone = Tone::plain) {
    canvas.put(row++, form.figures_column, text, tone);
  };
  put("tracks    left  right", Tone::title);
  put("wanted " + measured(true, wish.track_mmps, 0) + "  mm/s");
  put("driven " + measured(has(kHasEncoders), status.track_mmps, 0) + "  mm/s");
  put("current" + measured(has(kHasCurrents), status.track_a, 1) + "  A");
  put("flipper   fr.l   fr.r   re.l   re.r", Tone::title);
  std::string sent = "sent   ";
  for (std::size_t i = 0; i < kFlipperCount; ++i) {
    sent += measured((status.flippers_commanded >> i & 1) != 0, status.commanded_flipper_deg[i], 0);
  }
  put(sent + " deg");
  put("angle  " + measured(has(kHasFlippers), status.flipper_deg, 0) + " deg");
  put("current" + measured(has(kHasCurrents), status.flipper_a, 1) + " A");
  put(fmt::format("battery {} V", measured(has(kHasBattery), status.battery_v, 1)));
}

void draw_place(Canvas& canvas, const Status& status, const Form& form) {
  const auto& [roll, pitch, yaw] = status.posture_deg;
  if ((status.fields & kHasPosture) != 0) {
    const bool is_steep = std::abs(roll) > 25 || std::abs(pitch) > 40;
    canvas.put(form.place, 1,
               fmt::format("nose {} {} roll {} yaw {}", pitch < 0.05 ? "up" : "DOWN", number(std::abs(pitch), 1),
                           to_side(roll, 1, "right", "left"), to_side(yaw, 0, "left", "right")),
               is_steep ? Tone::warning : Tone::plain);
  }
  const bool has_pose = (status.fields & kHasPose) != 0;
  const auto metres = [](double mm) { return number(mm / 1e3, 2); };
  canvas.put(
      form.full ? form.place : form.place + 1, form.full ? 47 : 1,
      has_pose ? fmt::format("place {} {} {} m (true)", metres(status.pose_mm[0]), metres(status.pose_mm[1]),
                             metres(status.pose_mm[2]))
               : fmt::format("place {} {} m (by the tracks)", metres(status.odometry[0]), metres(status.odometry[1])));
}

void draw_desk(Canvas& canvas, const View& view, const Form& form) {
  std::string desk = fmt::format("speed {:.0f} mm/s   posture: {}", view.desk.speed_mmps(), view.desk.posture());
  if (form.full) desk += fmt::format("   gamepad: {}", view.gamepad.empty() ? "none" : view.gamepad);
  canvas.put(form.desk, 1, desk);
  const std::size_t flag = form.full ? 60 : 42;
  if (view.wish.emergency_stop) canvas.put(form.desk, flag, "EMERGENCY PRESSED", Tone::alarm);
  if (view.wish.deadman) canvas.put(form.desk, flag, "DEAD-MAN HELD", Tone::good);
  if (view.status != nullptr) {
    const bool is_degraded = (view.status->flags & kDegraded) != 0;
    const std::string_view warning = teleop::view(view.status->warning);
    canvas.put(form.desk + 1, 1, is_degraded ? warning : teleop::view(view.status->message),
               is_degraded                           ? Tone::warning
               : view.status->mode == Mode::no_robot ? Tone::alarm
                                                     : Tone::dim);
  }
  if (form.full) {
    canvas.put(form.desk + 2, 1,
               view.camera.empty() ? "camera: no address given (--camera)" : fmt::format("camera: {}", view.camera),
               Tone::dim);
  }
}

void draw_help(Canvas& canvas, const Form& form) {
  canvas.put(form.help, 1,
             form.full ? "w s a d, arrows: drive, turn  home pgup end pgdn: arcs  space: stand  +-: speed"
                       : "w s a d, arrows: drive  space: stand  +-: speed");
  canvas.put(form.help + 1, 1, "E EMERGENCY STOP   X releases it   Q quit", Tone::alarm);
  std::string postures = form.full ? "posture:" : "";
  for (std::size_t i = 0; i < kPostures.size(); ++i) {
    postures += form.full ? fmt::format(" {} {} ", i + 1, kPostures[i].name)
                          : fmt::format("{}{}{}", i == 0 ? "" : " ", i + 1, kPostures[i].name);
  }
  canvas.put(form.help + 2, 1, postures);
  canvas.put(form.help + 3, 1,
             form.full ? "flippers up/down: front r/f  rear t/g   one: front u/j i/k  rear o/l p/;"
                       : "flippers: front r/f rear t/g  one: u/j i/k o/l p/;");
}

}  // namespace

void Canvas::put(std::size_t row, std::size_t column, std::string_view text, Tone tone) {
  if (row >= rows()) return;
  for (std::size_t i = 0; i < text.size() && column + i < columns(); ++i) {
    const char character = text[i];
    cells[row][column + i] = {character >= ' ' && character <= '~' ? character : '?', tone};
  }
}

std::string Canvas::line(std::size_t row) const {
  std::string text;
  for (const Cell& cell : cells.at(row)) text += cell.character;
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

void draw_posture(Canvas& canvas, std::size_t row, std::size_t column, const Status& status, std::size_t scale) {
  constexpr double kRadians = std::numbers::pi / 180;
  const bool has_posture = (status.fields & kHasPosture) != 0;
  SideView view(canvas, row, column, has_posture ? -status.posture_deg[1] * kRadians : 0, scale);
  const double end_x_mm = kPivotX_mm + 65;
  view.line({-end_x_mm + 40, kBelly_mm}, {end_x_mm - 40, kBelly_mm}, Tone::plain);
  view.line({-kPivotX_mm, kBodyTop_mm}, {kPivotX_mm, kBodyTop_mm}, Tone::plain);
  view.line({-end_x_mm, kBelly_mm + 50}, {-kPivotX_mm, kBodyTop_mm}, Tone::plain);
  view.line({end_x_mm, kBelly_mm + 50}, {kPivotX_mm, kBodyTop_mm}, Tone::plain);
  if ((status.fields & kHasFlippers) != 0) {
    for (std::size_t i = 0; i < kFlipperCount; ++i) {
      const double forward = i == kFrontLeft || i == kFrontRight ? 1 : -1;
      const Point pivot{forward * kPivotX_mm, kPivotZ_mm};
      const double angle_rad = status.flipper_deg[i] * kRadians;
      view.line(pivot,
                {pivot.x_mm + forward * 1.3 * kFlipper_mm * std::cos(angle_rad),
                 pivot.z_mm + 1.3 * kFlipper_mm * std::sin(angle_rad)},
                Tone::good);
    }
  }
  view.dot({kPivotX_mm, kPivotZ_mm}, 'o', Tone::title);
  view.dot({-kPivotX_mm, kPivotZ_mm}, 'o', Tone::title);
  view.dot({0, 0}, '>', Tone::dim);
}

Canvas draw_screen(const View& view, std::size_t rows, std::size_t columns) {
  Canvas canvas(std::min(rows, kMostRows), std::min(columns, kMostColumns));
  const Form form = form_of(canvas.rows(), canvas.columns());
  if (form.full) {
    canvas.put(0, 0, fmt::format(" KENAF  operator's console   control process at {}", view.control), Tone::title);
    for (const std::size_t row : {form.figures - 1, form.place + 1, form.help - 1}) draw_rule(canvas, row);
  }
  draw_link(canvas, view, form);
  if (view.status != nullptr) {
    if (form.full) {
      const std::size_t scale = std::max<std::size_t>(
          1, std::min((form.place - form.figures) / kPostureRows, (form.figures_column - 1) / kPostureColumns));
      draw_posture(canvas, form.figures, 1, *view.status, scale);
    }
    draw_state(canvas, *view.status, form);
    draw_measured(canvas, *view.status, view.wish, form);
    draw_place(canvas, *view.status, form);
  }
  draw_desk(canvas, view, form);
  draw_help(canvas, form);
  return canvas;
}

std::string plain_line(const View& view) {
  if (view.taken) return fmt::format("taken: {}", *view.taken);
  const std::optional<double> silence_s = view.health.silence_s(view.now_s);
  if (view.status == nullptr || !silence_s) return fmt::format("nothing heard from {}", view.control);
  const Status& status = *view.status;
  const auto if_has = [&](std::uint32_t field, double value, int digits) {
    return figure((status.fields & field) != 0, value, digits);
  };
  std::string line =
      fmt::format("{:<14} t {:.2f} s  rtt {:.0f} ms  heard {:.2f} s ago  lost {:.0f}/{:.0f} %", name_of(status.mode),
                  status.robot_time_s, 1e3 * view.health.round_trip_s().value_or(0), *silence_s,
                  view.health.loss_up_percent(), view.health.loss_down_percent());
  line += "  tracks";
  for (const double mmps : status.track_mmps) line += ' ' + if_has(kHasEncoders, mmps, 0);
  line += " mm/s  nose up " + if_has(kHasPosture, -status.posture_deg[1], 1) + "  flippers";
  for (const double deg : status.flipper_deg) line += ' ' + if_has(kHasFlippers, deg, 0);
  line += "  battery " + if_has(kHasBattery, status.battery_v, 1) + " V";
  if (status.mode == Mode::halted) line += fmt::format("  halted by {}", name_of(status.halt));
  if (status.mode == Mode::no_robot) line += fmt::format("  {}", teleop::view(status.message));
  return line;
}

}  // namespace kenaf::teleop
