// What the 3D scene shows on top, in a real browser: contact forces, trails, sensors, points of view, places and
// distances.
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "tests/server/live/browser_desk.hpp"
#include "tests/support/patience.hpp"
#include "tests/support/usarsim_client.hpp"

namespace kenaf::live {

using nlohmann::json;

namespace {

// Whatever its link is like: these tests may run where a round trip takes seconds.
constexpr const char* kViewIsThere =
    "document.getElementById('world')?.textContent && document.getElementById('view-scale')?.textContent";

struct SceneDesk {
  support::TemporaryFolder profile;
  ServedWorld world;
  Browser browser;
  std::filesystem::path pictures = std::filesystem::path(KENAF_BIN_DIR) / ".." / "live-view";

  explicit SceneDesk(const std::string& name) : world("", patient_limits(), name), browser(profile.path()) {
    std::filesystem::create_directories(pictures);
    browser.resize(1280, 800);
    browser.open(world.url());
    ready();
  }
  void ready() {
    browser.wait_for(kViewIsThere);
    std::ifstream file(KENAF_PAGE_CHECKS);
    browser.evaluate(std::string(std::istreambuf_iterator<char>(file), {}) + ", 0");
  }
  void press(std::string_view code, std::string_view key = {}) {
    browser.key(code, true, key);
    browser.key(code, false, key);
  }
  // Until the promise that the expression gives is kept with true.
  void wait_for_promise(const std::string& expression) {
    INFO(expression);
    REQUIRE(support::eventually([&] { return browser.evaluate(expression) == true; }));
  }
  bool pressed(const std::string& button) {
    return browser.evaluate("document.getElementById('" + button + "').getAttribute('aria-pressed')") == "true";
  }
  std::string words(const std::string& id) {
    return browser.evaluate("document.getElementById('" + id + "').textContent");
  }
  // Keys choose a view once the scene is there.
  void look_from_above() {
    REQUIRE(support::eventually([&] {
      press("Digit7");
      return pressed("view-top");
    }));
  }
  void place_at_start() {
    browser.evaluate("document.getElementById('place').click()");
    press("Enter");
    browser.wait_for("document.getElementById('drive-state').dataset.state === 'held'");
  }
  json robots() {
    WebClient witness(world.port());
    REQUIRE(witness.open_websocket());
    return witness.message_of("state")["robots"];
  }
  // Presses the left button at a place of the ground, and lets go of it there. In the view from above, which looks down
  // on the middle of the picture from `reach_m`, with x up and y to the left.
  void click_from_above(double x_m, double y_m, double reach_m) {
    const json box = browser.evaluate(
        "(() => { const box = document.getElementById('canvas').getBoundingClientRect(); return [box.x, box.y, "
        "box.width, box.height]; })()");
    const double height_px = box[3];
    const double px_per_m =
        height_px / (2 * reach_m * std::tan(45.0 / 2 * std::acos(-1) / 180));  // stage.js: 45 degrees
    const double x_px = box[0].get<double>() + box[2].get<double>() / 2 - y_m * px_per_m;
    const double y_px = box[1].get<double>() + height_px / 2 - x_m * px_per_m;
    browser.mouse("mousePressed", x_px, y_px);
    browser.mouse("mouseReleased", x_px, y_px);
  }
  void check_no_complaints() {
    for (const std::string& complaint : browser.complaints()) UNSCOPED_INFO(complaint);
    CHECK(browser.complaints().empty());
  }
};

// stage.js: where one looks from at first.
const double kFirstReach_m = std::hypot(1.6, std::hypot(1.5, 1.25));

}  // namespace

TEST_CASE("In a browser: the ground's forces on a robot that stands add up to its weight") {
  SceneDesk desk("flat");
  desk.place_at_start();
  CHECK(desk.browser.evaluate("document.getElementById('forces-words').hidden") == true);
  desk.press("KeyN");
  CHECK(desk.pressed("show-forces"));
  // share/robots/kenaf.toml: 20 kg
  constexpr double kWeight_n = 20 * 9.80665;
  desk.browser.wait_for("Math.abs(Number(document.getElementById('forces-words').dataset.sum) - " +
                        std::to_string(kWeight_n) + ") < 0.01 * " + std::to_string(kWeight_n));
  const std::string words = desk.words("forces-words");
  CHECK(words.find("Ground on Manual1: 196.") == 0);
  CHECK(words.find("tracks 196.") != std::string::npos);
  CHECK(words.find("flippers") == std::string::npos);  // they are raised
  desk.browser.screenshot(desk.pictures / "forces.png");

  // arrows and points, over the robot: without them the picture is another
  desk.wait_for_promise(
      "(async () => { const button = document.getElementById('show-forces'); await keepCanvas(); button.click();"
      "  await canvasPixels(); const count = await canvasChanges(); button.click(); return count > 10; })()");
  CHECK(desk.pressed("show-forces"));
  desk.browser.screenshot(desk.pictures / "forces.png");

  // kept over a reload, switched off by the same key
  desk.browser.evaluate("location.reload()");
  desk.ready();
  desk.browser.wait_for("document.getElementById('forces-words').dataset.sum > 190");
  CHECK(desk.pressed("show-forces"));
  desk.press("KeyN");
  CHECK_FALSE(desk.pressed("show-forces"));
  CHECK(desk.browser.evaluate("document.getElementById('forces-words').hidden") == true);
  desk.check_no_complaints();
}

TEST_CASE("In a browser: vectors of contacts add up as vectors, by parts") {
  SceneDesk desk("flat");
  // left track 3 N up and 4 N ahead, right track 4 N back, front left flipper 12 N up: 15 N up in all; tracks 3 N
  const json sums = desk.browser.evaluate(
      "import('/contact_forces.js').then(({ sumsOf }) => sumsOf([[0, 0, 0, 0, 4, 0, 3], [1, 0, 0, 0, -4, 0, 0], [2, 0, "
      "0, 0, 0, 0, 12]]))");
  CHECK(sums["all"] == json::array({0, 0, 15}));
  CHECK(sums["tracks"] == json::array({0, 0, 3}));
  CHECK(sums["flippers"] == json::array({0, 0, 12}));
  // a vertical line of 0.5 m, and a slope of 3 in 4
  const json up =
      desk.browser.evaluate("import('/measuring.js').then(({ measure }) => measure([1, 2, 3], [1, 2, 3.5]))");
  CHECK(up["distance_m"] == Approx(0.5));
  CHECK(up["slope_deg"] == Approx(90));
  const json slope =
      desk.browser.evaluate("import('/measuring.js').then(({ measure }) => measure([0, 0, 0], [0, -4, -3]))");
  CHECK(slope["distance_m"] == Approx(5));
  CHECK(slope["horizontal_m"] == Approx(4));
  CHECK(slope["vertical_m"] == Approx(-3));
  CHECK(slope["slope_deg"] == Approx(-36.8699));
  // a right angle of two triangles has one sharp edge and four open ones; a flat pair has no edge between them
  const std::string edges =
      "import('/terrain.js').then(({ surfaceOf }) => surfaceOf(new Float32Array([0,0,0, 1,0,0, 1,1,0, 0,1,%]), "
      "new Uint32Array([0,1,2, 0,2,3])).edges.attributes.position.count / 2)";
  const auto with = [&](const std::string& height) { return std::string(edges).replace(edges.find('%'), 1, height); };
  CHECK(desk.browser.evaluate(with("0")) == 4);
  CHECK(desk.browser.evaluate(with("2")) == 5);
}

TEST_CASE("In a browser: a trail is thinned, bounded, and ends where time goes back") {
  SceneDesk desk("flat");
  const auto places = [&](const std::string& steps) {
    return desk.browser.evaluate(
        "import('/trail.js').then(({ createPlaces }) => { const { places, add } = createPlaces(); const way = (x, t) "
        "=> add([x, 0, 0], [0, 1, 0], t, 0.5); " +
        steps + "; return places.map(({ p, t, jump }) => [p[0], t, jump]); })");
  };
  // 1 mm a state: a place each 30 mm
  const json thin = places("for (let i = 0; i <= 100; ++i) way(0.001 * i + 1e-9 * i, 0.03 * i)");
  REQUIRE(thin.size() == 4);
  CHECK(thin[1][0] == Approx(0.03).margin(1e-3));
  // what is older than five minutes is left out, and so is what is more than can be kept
  const json late = places("way(0, 0); way(0.1, 1); way(0.2, 301); way(0.3, 302)");
  CHECK(late.size() == 2);
  CHECK(places("for (let i = 0; i < 10000; ++i) way(0.1 * i, 0.01 * i)").size() == 4000);
  // a reset clears it; a robot that is put elsewhere has driven no line there
  CHECK(places("way(0, 5); way(1, 6); way(0, 0)").size() == 1);
  const json put = places("way(0, 0); way(0.04, 0.1); way(5, 0.2); way(5.04, 0.3)");
  REQUIRE(put.size() == 4);
  CHECK(put[1][2] == false);
  CHECK(put[2][2] == true);
  CHECK(put[3][2] == false);
}

TEST_CASE("In a browser: a trail is behind a robot that drove, and a reset clears it") {
  SceneDesk desk("flat");
  desk.place_at_start();
  desk.press("KeyB");
  CHECK(desk.pressed("show-trail"));
  desk.press("Digit7");
  desk.browser.key("KeyW", true);
  // trail.js: the second colour, of the robot numbered 1; as the light and the fog leave it
  desk.wait_for_promise("canvasCount('--c2', 12).then((count) => count > 20)");
  desk.browser.key("KeyW", false);
  desk.browser.screenshot(desk.pictures / "trail.png");
  desk.browser.evaluate("document.getElementById('reset').click()");
  desk.browser.wait_for("!document.getElementById('question-yes').disabled");
  desk.browser.evaluate("document.getElementById('question-yes').click()");
  desk.wait_for_promise("canvasCount('--c2', 12).then((count) => count === 0)");
  desk.check_no_complaints();
}

TEST_CASE("In a browser: hills and rubble stand out from level ground, in light and dark") {
  for (const char* name : {"flat", "hills", "rubble-mesh"}) {
    SceneDesk desk(name);
    desk.place_at_start();
    desk.press("Digit6");  // from behind, over the robot, at what begins 1 m ahead
    for (const bool dark : {false, true}) {
      desk.browser.set_dark(dark);
      desk.browser.wait_for(std::string("matchMedia('(prefers-color-scheme: dark)').matches === ") +
                            (dark ? "true" : "false"));
      INFO(name << (dark ? ", dark" : ", light"));
      // between a third of the picture and two thirds; level ground has lines, and otherwise one colour
      if (std::string(name) == "flat")
        desk.wait_for_promise("canvasContrast(0.12, 0.4).then((contrast) => contrast < 1.25)");
      else
        desk.wait_for_promise("canvasContrast(0.12, 0.4).then((contrast) => contrast > 1.3)");
      desk.browser.screenshot(desk.pictures / (std::string("terrain-") + name + (dark ? "-dark.png" : "-light.png")));
    }
    desk.check_no_complaints();
  }
}

TEST_CASE("In a browser: a robot is placed where one clicks, or by the keyboard, and Esc places none") {
  SceneDesk desk("flat");
  desk.look_from_above();
  desk.browser.evaluate("document.getElementById('place').click()");
  CHECK(desk.pressed("place"));
  desk.press("Escape");
  CHECK_FALSE(desk.pressed("place"));
  CHECK(desk.robots().empty());

  desk.browser.evaluate("document.getElementById('place').click()");
  desk.click_from_above(0.3, 0.5, kFirstReach_m);
  desk.browser.wait_for("document.getElementById('drive-state').dataset.state === 'held'");
  CHECK_FALSE(desk.pressed("place"));
  json robots = desk.robots();
  REQUIRE(robots.size() == 1);
  CHECK(robots[0]["p"][0] == Approx(0.3).margin(0.03));
  CHECK(robots[0]["p"][1] == Approx(0.5).margin(0.03));

  // Esc gives up the place, and not the robot that is held; keys do not drive it meanwhile
  desk.browser.evaluate("document.getElementById('place').click()");
  desk.press("ArrowUp");
  desk.press("Escape");
  CHECK(desk.browser.evaluate("document.getElementById('drive-state').dataset.state") == "held");

  // Nor does a place that is taken: the middle of the view, where the robot is.
  desk.browser.evaluate("document.getElementById('place').click()");
  desk.press("ArrowUp");
  desk.press("Enter");
  desk.browser.wait_for("document.getElementById('notice').textContent.includes('another robot')");
  CHECK(desk.browser.evaluate("document.getElementById('drive-state').dataset.state") == "held");

  // by arrows: the first begins in the middle of the view, each next goes 0.1 m; turned to the left by 15 degrees each
  desk.browser.evaluate("document.getElementById('place').click()");
  for (int i = 0; i < 11; ++i) desk.press("ArrowRight");
  for (int i = 0; i < 2; ++i) desk.press("Comma", ",");
  desk.press("Enter");
  desk.browser.wait_for("document.getElementById('robot').options.length === 2");
  robots = desk.robots();
  REQUIRE(robots.size() == 2);
  CHECK(robots[1]["p"][0] == Approx(robots[0]["p"][0].get<double>()).margin(0.03));
  CHECK(robots[1]["p"][1] == Approx(robots[0]["p"][1].get<double>() - 1).margin(0.03));
  CHECK(robots[1]["q"][3] == Approx(std::sin(std::acos(-1) / 12)).margin(0.01));  // 30 degrees
  desk.browser.screenshot(desk.pictures / "placed.png");
  desk.check_no_complaints();
}

TEST_CASE("In a browser: a click on a robot chooses it, and a drag does not") {
  SceneDesk desk("flat");
  support::UsarsimClient one(desk.world.usarsim_port()), two(desk.world.usarsim_port());
  one.send("INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n");
  desk.browser.wait_for("document.getElementById('robot').options.length === 1");
  two.send("INIT {ClassName USARBot.Kenaf} {Name R2} {Location 0,-0.7,0}\r\n");  // to the left
  desk.browser.wait_for("document.getElementById('robot').options.length === 2");
  const std::string chosen = "document.getElementById('robot').selectedOptions[0]?.text";
  desk.browser.wait_for(chosen + " === 'R1'");
  desk.look_from_above();
  // once it is drawn from above
  desk.browser.evaluate("canvasPixels().then(() => canvasPixels()).then(() => 0)");
  const double above_m = kFirstReach_m - 0.1;  // the deck, over the robot's middle, at which one looks
  desk.click_from_above(0, 0.7, above_m);
  desk.browser.wait_for(chosen + " === 'R2'");
  // now that one is in the middle, and the other to the right; a press that moves turns the view
  desk.browser.evaluate("canvasPixels().then(() => canvasPixels()).then(() => 0)");
  desk.browser.mouse("mousePressed", 200, 200);
  desk.browser.mouse("mouseMoved", 240, 200);
  desk.browser.mouse("mouseReleased", 240, 200);
  CHECK(desk.browser.evaluate(chosen) == "R2");
  desk.check_no_complaints();
}

TEST_CASE("In a browser: two clicks measure a distance, by the keyboard too") {
  SceneDesk desk("step-200");
  desk.press("Digit7");
  desk.press("KeyM");
  CHECK(desk.pressed("measure"));
  desk.click_from_above(0.2, 0.5, kFirstReach_m);
  desk.click_from_above(0.2, -0.5, kFirstReach_m);
  desk.browser.wait_for("document.getElementById('pointing-words').textContent.includes('horizontal')");
  const std::string words = desk.words("pointing-words");
  CHECK(std::stod(words) == Approx(1).margin(0.03));
  CHECK(words.find("vertical 0.000 m, slope 0.0") != std::string::npos);
  desk.press("KeyM");
  CHECK(desk.browser.evaluate("document.getElementById('pointing-words').hidden") == true);

  // from the middle of the view up to the step, 1 m ahead and 0.2 m high: 1.2 m and 0.2 m
  desk.press("KeyM");
  desk.press("ArrowUp");
  desk.press("Enter");
  for (int i = 0; i < 12; ++i) desk.press("ArrowUp");
  desk.press("Enter");
  CHECK(desk.words("pointing-words") ==
        "1.217 m: horizontal 1.200 m, vertical 0.200 m, slope 9.5\u00b0. Esc ends.");  // sqrt(1.44 + 0.04)
  desk.browser.screenshot(desk.pictures / "measured.png");
  desk.press("Escape");
  CHECK_FALSE(desk.pressed("measure"));
  desk.check_no_complaints();
}

TEST_CASE("In a browser: the point of view is chosen by keys and kept over a reload") {
  SceneDesk desk("flat");
  desk.place_at_start();
  for (const auto& [code, button] :
       {std::pair{"Digit6", "view-behind"}, std::pair{"Digit8", "view-side"}, std::pair{"Digit9", "view-free"},
        std::pair{"Digit5", "view-follow"}, std::pair{"Digit7", "view-top"}}) {
    desk.press(code);
    CHECK(desk.pressed(button));
    CHECK(desk.browser.evaluate("document.querySelectorAll('#view-tools [aria-pressed=true]').length") == 1);
  }
  desk.browser.evaluate("location.reload()");
  desk.ready();
  CHECK(desk.pressed("view-top"));
}

TEST_CASE("In a browser: what a robot's scanner and sonar have before them is shown and said") {
  SceneDesk desk("flat");
  support::UsarsimClient program(desk.world.usarsim_port());
  program.send(
      "CONTROL {Type Create} {ClassName Box} {Name wall} {Location 1,0,-0.5} {Scale 0.1,4,1}\r\n"
      "INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n");
  desk.browser.wait_for("document.getElementById('robot').options.length === 1");
  desk.press("KeyY");
  // the wall's face is at x = 0.95 m, scanner and sonar at 0.15 and 0.22 m of the robot, which stands at 0
  desk.browser.wait_for(
      "document.getElementById('sensor-words').textContent.includes('Scanner1 0.80 m; F1 0.73 m; felt 9.8')");
  desk.browser.screenshot(desk.pictures / "sensors.png");
  desk.press("KeyY");
  CHECK(desk.browser.evaluate("document.getElementById('sensor-words').hidden") == true);
  desk.check_no_complaints();
}

}  // namespace kenaf::live
