// The console's screen is tested as characters: it stays within its size and within printable ASCII. Mode, halt,
// silence and the holder of the robot stand there in words, and the posture is drawn as it is, so that front flippers
// that are up lie above the body's front.
#include "teleop/screen.hpp"

#include <catch2/catch.hpp>

using namespace kenaf::teleop;

namespace {

Status status_to_show() {
  Status status{};
  status.session = 1;
  status.sequence = 1;
  status.mode = Mode::driving;
  status.halt = Halt::silence;
  status.fields = kHasPosture | kHasEncoders | kHasFlippers | kHasCurrents | kHasBattery | kHasPose;
  status.flags = kSimulated;
  status.posture_deg = {1, -23.4, 5};
  status.track_mmps = {198, 201};
  status.flipper_deg = {58, 58, -20, -20};
  status.battery_v = 25.64;
  status.pose_mm = {842, 3, 200};
  return status;
}

struct Scene {
  Status status = status_to_show();
  LinkHealth health{};
  Desk desk{};
  Wish wish = desk.wish(10);

  View view(double now_s) { return {"10.0.0.5:45460", "", "", &status, {}, health, desk, wish, now_s}; }
};

std::string text_of_screen(const Canvas& canvas) {
  std::string text;
  for (std::size_t row = 0; row < canvas.rows(); ++row) text += canvas.line(row) + "\n";
  return text;
}

bool has(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("Text is cut at the edge and cannot steer the terminal") {
  Canvas canvas;
  canvas.put(3, 70, "abc\x1b[2Jdefghijkl");
  CHECK(canvas.line(3).size() == 80);
  CHECK(canvas.line(3).substr(70) == "abc?[2Jdef");
  canvas.put(24, 0, "below");
  canvas.put(23, 200, "beside");
  CHECK(canvas.line(23).empty());
}

TEST_CASE("The screen says in words what a person must see") {
  Scene scene;
  scene.health.sent(1, 9.7);
  scene.status.newest_wish = 1;
  scene.health.heard(scene.status, 9.9);
  std::string text = text_of_screen(draw_screen(scene.view(10)));
  CHECK(has(text, "10.0.0.5:45460"));
  CHECK(has(text, "round trip 200 ms"));
  CHECK(has(text, "DRIVING"));
  CHECK(has(text, "simulated"));
  CHECK(has(text, "nose up 23.4"));
  CHECK(has(text, "driven     198    201  mm/s"));
  CHECK(has(text, "25.6 V"));
  CHECK(has(text, "E EMERGENCY STOP"));
  CHECK(has(text, "1 folded"));
  CHECK(has(text, "6 tall"));
  CHECK(has(text, "+-: speed\n"));  // the longest line of help is not cut

  scene.status.mode = Mode::halted;
  CHECK(has(text_of_screen(draw_screen(scene.view(10))), "HALTED by silence of this console"));
  scene.status.mode = Mode::emergency_stop;
  CHECK(has(text_of_screen(draw_screen(scene.view(10))), "EMERGENCY STOP - X releases it"));
  CHECK(has(text_of_screen(draw_screen(scene.view(13.9))), "SILENT for 4.0 s"));
  scene.status.mode = Mode::no_robot;
  scene.status.message = text_of("HRT_E_LINK: the relay is silent");
  CHECK(has(text_of_screen(draw_screen(scene.view(10))), "HRT_E_LINK: the relay is silent"));
  CHECK(has(plain_line(scene.view(10)), "HRT_E_LINK: the relay is silent"));

  View view = scene.view(10);
  view.taken = "the console at 10.0.0.9:5 has the robot";
  CHECK(has(text_of_screen(draw_screen(view)), "TAKEN: the console at 10.0.0.9:5"));
  view.taken.reset();
  view.status = nullptr;
  CHECK(has(plain_line(view), "nothing heard from 10.0.0.5:45460"));
  CHECK(draw_screen(view).line(1) == " link   ok  round trip 200 ms   lost up 0 %  down 0 %   heard 0.10 s ago");
}

TEST_CASE("What was not measured is not shown as a number") {
  Scene scene;
  scene.status.fields = 0;
  const std::string text = text_of_screen(draw_screen(scene.view(10)));
  CHECK(has(text, "driven       -      -  mm/s"));
  CHECK_FALSE(has(text, "nose"));
  CHECK(has(text, "(by the tracks)"));

  scene.health.heard(scene.status, 9.9);
  CHECK(has(plain_line(scene.view(10)), "  tracks - - mm/s  nose up -  flippers - - - -  battery - V"));
  scene.status.fields = kHasEncoders | kHasFlippers;
  CHECK(has(plain_line(scene.view(10)), "  tracks 198 201 mm/s  nose up -  flippers 58 58 -20 -20  battery - V"));
  scene.status.fields = status_to_show().fields;
  CHECK(has(plain_line(scene.view(10)), "  nose up 23.4  flippers 58 58 -20 -20  battery 25.6 V"));
}

TEST_CASE("On 60 x 20 nothing is cut, and smaller terminals still show link and mode") {
  Scene scene;
  scene.health.sent(1, 9.7);
  scene.status.newest_wish = 1;
  scene.health.heard(scene.status, 9.9);
  const Canvas small = draw_screen(scene.view(10), 20, 60);
  CHECK(small.rows() == 20);
  CHECK(small.columns() == 60);
  const std::string text = text_of_screen(small);
  for (const char* part :
       {"link   ok  200 ms  lost 0/0 %  heard 0.10 s ago", "robot  DRIVING", "driven     198    201  mm/s",
        "battery    25.6 V", "nose up 23.4 roll 1.0 right yaw 5 left\n", "place 0.84 0.00 0.20 m (true)\n",
        "+-: speed\n", "Q quit\n", "6tall\n", "o/l p/;\n"}) {
    INFO(part);
    CHECK(has(text, part));
  }
  // of 1 row, of 2, of 10
  CHECK(has(text_of_screen(draw_screen(scene.view(10), 1, 40)), "link   ok"));
  for (const std::size_t rows : {2u, 10u}) {
    const std::string least = text_of_screen(draw_screen(scene.view(10), rows, 40));
    CHECK(has(least, "link   ok"));
    CHECK(has(least, "DRIVING"));
  }
  draw_screen(scene.view(10), 0, 0);
}

TEST_CASE("A large terminal is used: rules over its width, help at its end, figures at its right, a larger drawing") {
  Scene scene;
  const Canvas large = draw_screen(scene.view(10), 60, 160);
  CHECK(large.line(4) == std::string(160, '-'));
  CHECK(has(large.line(59), "flippers up/down"));
  CHECK(large.line(5).substr(120, 6) == "tracks");
  // 36 more rows: (50 - 5) / 9 = 5 times as high, (120 - 1) / 38 = 3 times as wide; 3 times. The body's middle is in
  // row 5 + 27 / 2 and column 1 + 114 / 2.
  CHECK(large.cells[5 + 13][1 + 57].character == '>');
}

TEST_CASE("A rounded zero has no sign, and left is called left") {
  Scene scene;
  scene.status.track_mmps = {-0.3, 0.3};
  scene.status.flipper_deg = {-0.2, 0, 0, 0};
  scene.status.posture_deg = {-0.04, -0.01, -0.3};
  scene.status.pose_mm = {-1, -4, 0};
  const std::string text = text_of_screen(draw_screen(scene.view(10)));
  CHECK_FALSE(has(text, "-0 "));
  CHECK_FALSE(has(text, "-0.0"));
  CHECK(has(text, "nose up 0.0 roll 0.0 yaw 0 "));
  scene.health.heard(scene.status, 9.9);
  CHECK(has(plain_line(scene.view(10)), "  tracks 0 0 mm/s  nose up 0.0  flippers 0 0 0 0"));
  // z-y-x angles of a body with x forward, y left: a positive roll lowers the right side, a positive yaw turns left
  scene.status.posture_deg = {-30, 41, -120};
  CHECK(has(text_of_screen(draw_screen(scene.view(10))), "nose DOWN 41.0 roll 30.0 left yaw 120 right"));
}

TEST_CASE("The posture is drawn as it is") {
  // Level, front flippers straight up, rear ones straight out. The field is 9 rows and 38 columns, its middle row 4 and
  // column 19; 30 mm a column, 60 mm a row. The front pivot at x = 225 mm, z = -25 mm is column 19 + 8 = 27 (7.5 rounds
  // up), row 4; the flipper's tip, 1.3 * 145 mm above it, is at 163 mm, row 4 - 3 = 1; the rear one reaches to
  // -225 - 188 mm, column 19 - 14 = 5.
  Status status = status_to_show();
  status.posture_deg = {};
  status.flipper_deg = {90, 90, 0, 0};
  Canvas canvas;
  draw_posture(canvas, 0, 0, status);
  CHECK(canvas.cells[1][27].character == '|');
  CHECK(canvas.cells[0][27].character == ' ');
  CHECK(canvas.cells[4][5].character == '-');
  CHECK(canvas.cells[4][4].character == ' ');
  CHECK(canvas.cells[4][27].character == 'o');
  CHECK(canvas.cells[6][19].character == '-');  // the belly, 90 mm below the middle: 1.5 rows, which rounds away

  // Nose up by 30 degrees: the front pivot is at z = 225 sin 30 - 25 cos 30 = 91 mm, row 4 - 2 (1.51 rounds up).
  status.posture_deg = {0, -30, 0};
  Canvas tilted;
  draw_posture(tilted, 0, 0, status);
  // x = 225 cos 30 + 25 sin 30 = 207 mm, column 19 + 7
  CHECK(tilted.cells[2][26].character == 'o');
}
