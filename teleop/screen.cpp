#include "screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kenaf::teleop {

namespace {

constexpr double kSilent_s = 0.5;  // a pause of this length without a status is shown as silence
constexpr std::string_view kRule = "--------------------------------------------------------------------------------";

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
  SideView(Canvas& canvas, std::size_t row, std::size_t column, double nose_up_rad)
      : canvas_(canvas), row_(row), column_(column), cos_(std::cos(nose_up_rad)), sin_(std::sin(nose_up_rad)) {}

  void line(Point from, Point to, Tone tone) {
    const Point a = turned(from), b = turned(to);
    const double steps = std::max(std::abs(b.x_mm - a.x_mm) / kColumn_mm, std::abs(b.z_mm - a.z_mm) / kRow_mm);
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
    const auto column = static_cast<int>(std::lround(x_mm / kColumn_mm)) + static_cast<int>(kPostureColumns / 2);
    const auto row = static_cast<int>(kPostureRows / 2) - static_cast<int>(std::lround(z_mm / kRow_mm));
    if (column < 0 || column >= static_cast<int>(kPostureColumns) || row < 0 || row >= static_cast<int>(kPostureRows)) {
      return;
    }
    canvas_.put(row_ + static_cast<std::size_t>(row), column_ + static_cast<std::size_t>(column),
                std::string_view(&character, 1), tone);
  }

  Canvas& canvas_;
  std::size_t row_, column_;
  double cos_, sin_;
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

std::string figure(bool has, double value, int digits) {
  return has ? fmt::format("{:.{}f}", value, digits) : "-";
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

void draw_link(Canvas& canvas, const View& view) {
  canvas.put(0, 0, fmt::format(" KENAF  operator's console   control process at {}", view.control), Tone::title);
  const std::optional<double> silence_s = view.health.silence_s(view.now_s);
  canvas.put(1, 1, "link");
  if (view.taken) {
    canvas.put(1, 8, fmt::format("TAKEN: {}", *view.taken), Tone::alarm);
  } else if (!silence_s) {
    canvas.put(1, 8, "nothing heard yet", Tone::alarm);
  } else if (*silence_s > kSilent_s) {
    canvas.put(1, 8, fmt::format("SILENT for {:.1f} s: the values below are old", *silence_s), Tone::alarm);
  } else {
    const double up = view.health.loss_up_percent(), down = view.health.loss_down_percent();
    canvas.put(1, 8, "ok", Tone::good);
    canvas.put(1, 12,
               fmt::format("round trip {:3.0f} ms   lost up {:.0f} %  down {:.0f} %   heard {:.2f} s ago",
                           1e3 * view.health.round_trip_s().value_or(0), up, down, *silence_s),
               up > 20 || down > 20 ? Tone::warning : Tone::plain);
  }
}

void draw_state(Canvas& canvas, const Status& status) {
  canvas.put(2, 1, "robot");
  canvas.put(2, 8, words_of(status), tone_of(status.mode));
  std::string notes = (status.flags & kSimulated) != 0 ? "simulated" : "real";
  if ((status.flags & kPaused) != 0) notes += ", PAUSED";
  if ((status.flags & kStoppedBySilence) != 0) notes += ", STOPPED: control too slow";
  if ((status.flags & kRecording) != 0) notes += ", recording";
  canvas.put(3, 8,
             fmt::format("{}   time {:.1f} s   round trip {:.1f} ms   late cycles {}", notes, status.robot_time_s,
                         status.robot_round_trip_ms, status.late_cycles),
             Tone::dim);
}

void draw_measured(Canvas& canvas, const Status& status, const Wish& wish) {
  constexpr std::size_t kColumn = 40;
  const auto has = [&](std::uint32_t field) { return (status.fields & field) != 0; };
  canvas.put(5, kColumn, "tracks    left  right", Tone::title);
  canvas.put(6, kColumn, "wanted " + measured(true, wish.track_mmps, 0) + "  mm/s");
  canvas.put(7, kColumn, "driven " + measured(has(kHasEncoders), status.track_mmps, 0) + "  mm/s");
  canvas.put(8, kColumn, "current" + measured(has(kHasCurrents), status.track_a, 1) + "  A");
  canvas.put(9, kColumn, "flipper   fr.l   fr.r   re.l   re.r", Tone::title);
  std::string sent = "sent   ";
  for (std::size_t i = 0; i < kFlipperCount; ++i) {
    sent += measured((status.flippers_commanded >> i & 1) != 0, status.commanded_flipper_deg[i], 0);
  }
  canvas.put(10, kColumn, sent + " deg");
  canvas.put(11, kColumn, "angle  " + measured(has(kHasFlippers), status.flipper_deg, 0) + " deg");
  canvas.put(12, kColumn, "current" + measured(has(kHasCurrents), status.flipper_a, 1) + " A");
  canvas.put(13, kColumn, fmt::format("battery {} V", measured(has(kHasBattery), status.battery_v, 1)));
}

void draw_place(Canvas& canvas, const Status& status) {
  const auto& [roll, pitch, yaw] = status.posture_deg;
  if ((status.fields & kHasPosture) != 0) {
    const bool is_steep = std::abs(roll) > 25 || std::abs(pitch) > 40;
    canvas.put(14, 1,
               fmt::format("nose {} {:.1f}  roll {:+.1f}  yaw {:+.1f} deg", pitch < 0.05 ? "up" : "DOWN",
                           std::abs(pitch), roll, yaw),
               is_steep ? Tone::warning : Tone::plain);
  }
  const bool has_pose = (status.fields & kHasPose) != 0;
  canvas.put(14, 44,
             has_pose ? fmt::format("place {:.2f} {:.2f} {:.2f} m (true)", status.pose_mm[0] / 1e3,
                                    status.pose_mm[1] / 1e3, status.pose_mm[2] / 1e3)
                      : fmt::format("place {:.2f} {:.2f} m (by the tracks)", status.odometry[0] / 1e3,
                                    status.odometry[1] / 1e3));
}

void draw_desk(Canvas& canvas, const View& view) {
  canvas.put(16, 1,
             fmt::format("speed {:.0f} mm/s   posture: {}   gamepad: {}", view.desk.speed_mmps(), view.desk.posture(),
                         view.gamepad.empty() ? "none" : view.gamepad));
  if (view.wish.emergency_stop) canvas.put(16, 60, "EMERGENCY PRESSED", Tone::alarm);
  if (view.wish.deadman) canvas.put(16, 60, "DEAD-MAN HELD", Tone::good);
  if (view.status != nullptr) {
    const bool is_degraded = (view.status->flags & kDegraded) != 0;
    const std::string_view warning = teleop::view(view.status->warning);
    canvas.put(17, 1, is_degraded ? warning : teleop::view(view.status->message),
               is_degraded                           ? Tone::warning
               : view.status->mode == Mode::no_robot ? Tone::alarm
                                                     : Tone::dim);
  }
  canvas.put(18, 1,
             view.camera.empty() ? "camera: no address given (--camera)" : fmt::format("camera: {}", view.camera),
             Tone::dim);
  canvas.put(20, 1, "w s a d, arrows: drive, turn  home pgup end pgdn: arcs  space: stop  +-: speed");
  canvas.put(21, 1, "E EMERGENCY STOP   X releases it   Q quit", Tone::alarm);
  std::string postures = "posture:";
  for (std::size_t i = 0; i < kPostures.size(); ++i) postures += fmt::format(" {} {} ", i + 1, kPostures[i].name);
  canvas.put(22, 1, postures);
  canvas.put(23, 1, "flippers up/down: front r/f  rear t/g   one: front u/j i/k  rear o/l p/;");
}

}  // namespace

void Canvas::put(std::size_t row, std::size_t column, std::string_view text, Tone tone) {
  if (row >= kRows) return;
  for (std::size_t i = 0; i < text.size() && column + i < kColumns; ++i) {
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

void draw_posture(Canvas& canvas, std::size_t row, std::size_t column, const Status& status) {
  constexpr double kRadians = std::numbers::pi / 180;
  const bool has_posture = (status.fields & kHasPosture) != 0;
  SideView view(canvas, row, column, has_posture ? -status.posture_deg[1] * kRadians : 0);
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

Canvas draw_screen(const View& view) {
  Canvas canvas;
  draw_link(canvas, view);
  canvas.put(4, 0, kRule, Tone::dim);
  if (view.status != nullptr) {
    draw_state(canvas, *view.status);
    draw_posture(canvas, 5, 1, *view.status);
    draw_measured(canvas, *view.status, view.wish);
    draw_place(canvas, *view.status);
  }
  canvas.put(15, 0, kRule, Tone::dim);
  draw_desk(canvas, view);
  canvas.put(19, 0, kRule, Tone::dim);
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
