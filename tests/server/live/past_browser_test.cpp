// Looking back, in a real browser: what is shown was, nothing drives meanwhile, the shown time becomes a run file, and
// any reading a plot.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "gap/commands/commands.hpp"
#include "tests/server/live/browser_desk.hpp"
#include "tests/support/patience.hpp"

namespace kenaf::live {

using nlohmann::json;

namespace {

void strike(Browser& browser, std::string_view code, std::string_view key = {}) {
  browser.key(code, true, key);
  browser.key(code, false, key);
}

// The x of the reading "Place", in m.
constexpr const char* kShownX =
    "parseFloat([...document.querySelectorAll('#readings dt')].find((dt) => dt.textContent === 'Place')"
    ".nextElementSibling.textContent)";

// The robot stands at x = 0 until the robot time is 2 s and more, then drives forward, and stands again.
void drive_on(Desk& desk) {
  desk.place();
  desk.browser.wait_for("parseFloat(document.getElementById('time').textContent) > 2");
  desk.browser.key("KeyW", true);
  desk.robot_with([](const json& robot) { return robot["p"][0] > 0.2; });
  desk.browser.key("KeyW", false);
  desk.robot_with(stands);
  desk.browser.wait_for(std::string(kShownX) + " > 0.15");
}

// The file that comes into the folder, whole.
std::filesystem::path only_file(const std::filesystem::path& folder, const std::string& extension) {
  std::filesystem::path found;
  REQUIRE(support::eventually([&] {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == extension && std::filesystem::file_size(entry.path()) > 0) found = entry.path();
    return !found.empty();
  }));
  return found;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// As the command line of kenaf-gap; throws where that fails.
void kenaf_gap(std::vector<std::string> arguments) {
  CLI::App app;
  gap::commands::add_dataset_command(app);
  gap::commands::add_check_command(app);
  std::ranges::reverse(arguments);
  app.parse(arguments);
}

}  // namespace

TEST_CASE("In a browser: one looks back while the world goes on, nothing drives meanwhile, and returns") {
  Desk desk;
  drive_on(desk);
  desk.browser.evaluate(
      "(() => { const send = WebSocket.prototype.send; window.sent = []; WebSocket.prototype.send = function (text) {"
      "  sent.push(JSON.parse(text)); send.call(this, text); }; })()");

  // the oldest, then about 1 s, when it stood at the start
  strike(desk.browser, "Home");
  strike(desk.browser, "Period");
  desk.browser.wait_for("!document.getElementById('past-banner').hidden");
  desk.browser.wait_for("Math.abs(" + std::string(kShownX) + ") < 0.01");
  desk.state_is("paused");
  CHECK(desk.browser.evaluate("document.getElementById('drive-state').textContent") ==
        "Manual1 stands: nothing drives while you look back");
  CHECK(desk.browser.evaluate("document.getElementById('past-banner').textContent")
            .get<std::string>()
            .find("with Space Manual1 stands") != std::string::npos);
  const double before_s = desk.browser.evaluate("parseFloat(document.getElementById('time').textContent)");
  desk.browser.wait_for("parseFloat(document.getElementById('time').textContent) > " + std::to_string(before_s + 0.2));

  // neither keys nor buttons nor the stick
  desk.browser.evaluate("sent.length = 0");
  desk.browser.key("KeyW", true);
  desk.browser.key("Digit2", true);
  desk.browser.click("[data-hold='front-up']");
  const json stick = desk.browser.evaluate(
      "(() => { const box = document.getElementById('stick').getBoundingClientRect();"
      "  return [box.x + box.width / 2, box.y + 0.1 * box.height]; })()");
  desk.browser.mouse("mousePressed", stick[0], stick[1]);
  desk.browser.wait_for("sent.filter((word) => word.type === 'drive').length > 5");
  const auto moves =
      "sent.some((word) => word.type === 'drive' && (word.left || word.right || word.flipper_angle || "
      "word.flipper_speed))";
  CHECK(desk.browser.evaluate(moves) == false);
  // Space is said at once, and looks back on
  CHECK(desk.browser.evaluate("(() => { const before = sent.length;"
                              "  dispatchEvent(new KeyboardEvent('keydown', { code: 'Space', key: ' ' }));"
                              "  return sent.slice(before).filter((word) => word.type === 'drive').length; })()") == 1);
  CHECK(desk.browser.evaluate("document.body.hasAttribute('data-past')") == true);

  // back to now: what is still down has to be pressed anew, the stick too
  strike(desk.browser, "Escape");
  desk.state_is("held");
  CHECK(desk.browser.evaluate("document.getElementById('past-banner').hidden") == true);
  desk.browser.wait_for(std::string(kShownX) + " > 0.15");
  desk.browser.mouse("mouseMoved", stick[0].get<double>() + 5, stick[1]);
  CHECK(desk.browser.evaluate(moves) == false);
  desk.browser.mouse("mouseReleased", stick[0], stick[1]);
  desk.browser.key("KeyW", false);
  desk.browser.key("Digit2", false);
  desk.browser.key("KeyW", true);
  desk.state_is("driving");
  // looking back lets go
  strike(desk.browser, "Comma");
  desk.state_is("paused");
  desk.robot_with(stands);
  desk.browser.key("KeyW", false);
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: one looks back in a world that is paused, and by the slider, and a reset ends it") {
  Desk desk;
  drive_on(desk);
  strike(desk.browser, "KeyP");
  desk.browser.wait_for("document.getElementById('pause').textContent === 'Resume'");
  const std::string slide =
      "(() => { const slider = document.getElementById('when'); slider.value = Number(slider.max) - 1;"
      "  slider.dispatchEvent(new Event('input')); })()";
  desk.browser.evaluate(slide);
  desk.browser.wait_for("document.getElementById('past-banner').textContent.includes('The world is paused')");
  // a thousandth of the minute that is shown
  CHECK(desk.browser.evaluate("document.getElementById('when-value').textContent") == "0.1 s ago");
  desk.browser.click("#live");
  CHECK(desk.browser.evaluate("document.getElementById('past-banner').hidden") == true);
  strike(desk.browser, "Comma");
  desk.browser.wait_for("document.getElementById('when-value').textContent === '1.0 s ago'");
  // with Shift ten times as far, but not farther than what is kept
  desk.browser.evaluate(
      "for (let i = 0; i < 40; ++i) dispatchEvent(new KeyboardEvent('keydown', { code: 'Comma', shiftKey: true }))");
  CHECK(std::abs(desk.browser.evaluate(kShownX).is_number() ? desk.browser.evaluate(kShownX).get<double>() : 0.0) <
        0.01);
  strike(desk.browser, "KeyP");
  WebClient other(desk.world.port());
  REQUIRE(other.open_websocket());
  other.send_text(R"({"type":"reset"})");
  desk.browser.wait_for("document.getElementById('past-banner').hidden");
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: a replay shows what was, moment by moment, and ends live") {
  Desk desk;
  drive_on(desk);
  // it has stood for longer than a picture of the replay may take
  desk.browser.evaluate("window.stood_s = parseFloat(document.getElementById('time').textContent), 0");
  desk.browser.wait_for("parseFloat(document.getElementById('time').textContent) > stood_s + 1");
  desk.browser.evaluate(
      "window.places = [], new MutationObserver(() => { if (document.body.hasAttribute('data-past')) places.push(" +
      std::string(kShownX) + "); }).observe(document.getElementById('readings'), { subtree: true, childList: true })");
  strike(desk.browser, "Backspace");
  desk.state_is("paused");
  desk.browser.wait_for("document.getElementById('replay').ariaPressed === 'true'");
  desk.browser.wait_for("document.getElementById('past-banner').hidden");
  desk.browser.wait_for("document.getElementById('replay').ariaPressed === 'false'");
  desk.state_is("held");
  // from where it stood to where it stands, forward all the way
  const std::string known = "places.filter((x) => !Number.isNaN(x))";
  CHECK(desk.browser.evaluate(known + "[0]") < 0.1);
  CHECK(desk.browser.evaluate(known + ".at(-1)") > 0.15);
  CHECK(desk.browser.evaluate(kShownX) > 0.15);
  CHECK(desk.browser.evaluate(known + ".every((x, i, all) => i === 0 || x >= all[i - 1] - 0.02)") == true);
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: what is kept is bounded in time and in bodies, and keeps its newest moment") {
  Desk desk;
  // 1000 moments, 10 a second; with 10 robots only every tenth of a second fits: 20 s x 10 robots / 400 = 0.5 s apart
  desk.browser.evaluate(
      "import('/history.js').then(({ createHistory }) => { window.keep = (robots) => {"
      "  const history = createHistory({ kept_s: 20, mostBodies: 400 });"
      "  const worlds = (i) => ({ time_s: i / 10, boxes: [], robots: new Map(Array.from({ length: robots }, (_, id) =>"
      "    [id + 1, { about: { id: id + 1 }, now: { i } }])) });"
      "  for (let i = 0; i <= 1000; ++i) history.take(worlds(i));"
      "  const all = history.between(-1, 1e9);"
      "  const result = { count: all.length, first: history.first_s(), last: history.last_s(),"
      "    at_95: history.at(95.04).robots.get(1).now.i };"
      "  history.take(worlds(5)); return { ...result, after: history.between(-1, 1e9).length }; }; return 0; })");
  const json one = desk.browser.evaluate("keep(1)");
  CHECK(one["count"] == 201);  // 80 s to 100 s
  CHECK(one["first"] == 80);
  CHECK(one["last"] == 100);
  CHECK(one["at_95"] == 950);
  CHECK(one["after"] == 1);  // time began anew
  const json ten = desk.browser.evaluate("keep(10)");
  CHECK(ten["count"] <= 40);
  CHECK(ten["count"] >= 35);
  CHECK(ten["first"] <= 83);
  CHECK(ten["last"] == 100);
  const json more_than_fit = desk.browser.evaluate("keep(500)");
  CHECK(more_than_fit["count"] == 1);
  CHECK(more_than_fit["last"] == 100);
}

TEST_CASE("In a browser: the shown time is saved as a run that kenaf-gap takes") {
  support::TemporaryFolder files;
  Desk desk;
  desk.browser.download_to(files.path());
  drive_on(desk);
  // flippers too, as they are ordered
  desk.browser.key("Digit1", true);
  desk.robot_with([](const json& robot) { return std::abs(robot["flipper"][0].get<double>()) < 0.05; });
  desk.browser.key("Digit1", false);
  desk.browser.wait_for("!document.getElementById('save-run').disabled");
  desk.browser.click("#save-run");
  const std::filesystem::path file = only_file(files.path(), ".csv");
  CHECK(file.filename().string().starts_with("step-200-Manual1-"));
  const runs::Run run = runs::read_run(file);
  CHECK(run.reading.empty());  // as the format is
  CHECK(run.column("t_s").front() == 0);
  CHECK(run.row_count() > 20);
  CHECK(run.column("x_m").back() > 0.2);
  CHECK(run.column("track_left_m").back() > 0.2);
  CHECK(std::ranges::max(run.column("cmd_track_left_mps")) > 0.1);
  CHECK(runs::any_measured(run.column("cmd_flipper_fl_rad")));
  CHECK(std::abs(run.column("flipper_fl_rad").back()) < 0.06);

  CHECK_NOTHROW(kenaf_gap({"check", file.string()}));
  const std::string dataset = files.path() / "dataset";
  CHECK_NOTHROW(kenaf_gap({"dataset", file.string(), "--manoeuvre", "by-hand", "--robot", "kenaf", "--world",
                           "step-200", "--source", "sim", "--out", dataset}));
  CHECK_NOTHROW(kenaf_gap({"check", dataset, "--strict"}));
}

TEST_CASE("In a browser: the world in 3D and a camera's picture are saved as PNG") {
  support::TemporaryFolder worlds, cameras;
  Desk desk;
  desk.place();
  desk.browser.wait_for("document.querySelector('#pictures img')?.naturalWidth > 0");
  const auto size_of = [](const std::string& png) {  // PNG, section 11.2.2: width and height begin the first chunk
    const auto number = [&](std::size_t at) {
      int value = 0;
      for (std::size_t i = at; i < at + 4; ++i) value = value * 256 + static_cast<unsigned char>(png[i]);
      return value;
    };
    REQUIRE(png.starts_with("\x89PNG\r\n\x1a\n"));
    return std::pair(number(16), number(20));
  };
  desk.browser.download_to(worlds.path());
  desk.browser.click("#save-picture");
  const auto [width, height] = size_of(bytes_of(only_file(worlds.path(), ".png")));
  CHECK(width == desk.browser.evaluate("document.getElementById('view').clientWidth"));
  CHECK(height == desk.browser.evaluate("document.getElementById('view').clientHeight"));

  strike(desk.browser, "KeyZ");
  desk.browser.download_to(cameras.path());
  desk.browser.click("#save-picture");
  const std::filesystem::path of_camera = only_file(cameras.path(), ".png");
  CHECK(size_of(bytes_of(of_camera)) == std::pair(640, 480));
  CHECK(of_camera.filename().string().starts_with("step-200-Camera-"));
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: a reading that is pressed is plotted, with its values at the cursor, also after a reload") {
  Desk desk;
  drive_on(desk);
  const std::string plots = "[...document.querySelectorAll('.plot')].map((plot) => plot.dataset.signal).join()";
  CHECK(desk.browser.evaluate(plots) == "speed,pitch,currents");
  const std::string reading =
      "[...document.querySelectorAll('button.reading')].find((each) => each.textContent === 'Place')";
  desk.browser.evaluate(reading + ".click()");
  CHECK(desk.browser.evaluate(plots) == "speed,pitch,currents,place");
  CHECK(desk.browser.evaluate(reading + ".ariaPressed") == "true");
  const std::string x_of_plot = "parseFloat(document.querySelector('[data-signal=\"place\"] output').textContent)";
  desk.browser.wait_for(x_of_plot + " > 0.15");

  // under the pointer: a second after the start, when it stood there
  desk.browser.evaluate(
      "(() => { const canvas = document.querySelector('[data-signal=\"place\"] canvas'), box = "
      "canvas.getBoundingClientRect();"
      "  window.point = (type, t) => { const now = parseFloat(document.getElementById('time').textContent);"
      "    const x = box.x + 34 + (box.width - 38) * (1 - (now - t) / 60);"
      "    canvas.dispatchEvent(new PointerEvent(type, { pointerId: 1, button: 0, clientX: x, clientY: box.y + 5 })); "
      "};"
      "  canvas.setPointerCapture = () => {}; point('pointermove', 1); })()");
  CHECK(std::abs(desk.browser.evaluate(x_of_plot).get<double>()) < 0.01);
  CHECK(desk.browser.evaluate("document.getElementById('past-banner').hidden") == true);
  // pressed there: all is that moment
  desk.browser.evaluate("point('pointerdown', 1)");
  desk.browser.wait_for("Math.abs(" + std::string(kShownX) + ") < 0.01");
  CHECK(desk.browser.evaluate("document.getElementById('past-banner').hidden") == false);
  strike(desk.browser, "End");

  // more and less of the time
  desk.browser.evaluate(
      "(() => { const span = document.getElementById('span'); span.value = '120'; span.dispatchEvent(new "
      "Event('change')); })()");
  strike(desk.browser, "Minus", "-");
  CHECK(desk.browser.evaluate("document.getElementById('span').value") == "300");
  for (const char* shorter : {"120", "60", "30"}) {
    strike(desk.browser, "Equal", "+");
    CHECK(desk.browser.evaluate("document.getElementById('span').value") == shorter);
  }
  CHECK(desk.browser.evaluate("document.getElementById('span').value") == "30");
  desk.browser.evaluate("document.querySelector('[data-signal=\"pitch\"] .plot-remove').click()");
  CHECK(desk.browser.evaluate(plots) == "speed,currents,place");
  desk.browser.evaluate("window.was_open = true, setTimeout(() => location.reload(), 50), 0");
  desk.browser.wait_for("!window.was_open && document.getElementById('link')?.dataset.state === 'good'");
  desk.browser.wait_for(plots + " === 'speed,currents,place'");
  CHECK(desk.browser.evaluate("document.getElementById('span').value") == "30");
  // none at all
  desk.browser.evaluate("document.querySelectorAll('.plot-remove').forEach((button) => button.click())");
  CHECK(desk.browser.evaluate("document.getElementById('no-plots').hidden") == false);
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE(
    "In a browser: a reading that is dragged to the plots is plotted, and dragged again, or elsewhere, changes "
    "nothing") {
  Desk desk;
  const std::string plots = "[...document.querySelectorAll('.plot')].map((plot) => plot.dataset.signal).join()";
  const auto middle_of = [&](const std::string& element) {
    return desk.browser.evaluate(
        "(() => { const box = " + element +
        ".getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })()");
  };
  const json reading =
      middle_of("[...document.querySelectorAll('button.reading')].find((each) => each.textContent === 'Heading')");
  const auto drag_to = [&](const json& place) {
    desk.browser.mouse("mousePressed", reading[0], reading[1]);
    desk.browser.mouse("mouseMoved", place[0], place[1]);
    desk.browser.mouse("mouseReleased", place[0], place[1]);
  };
  const json to_plots = middle_of("document.getElementById('timeline')");
  drag_to(to_plots);
  CHECK(desk.browser.evaluate(plots) == "speed,pitch,currents,heading");
  drag_to(to_plots);
  CHECK(desk.browser.evaluate(plots) == "speed,pitch,currents,heading");
  drag_to(middle_of("document.getElementById('view')"));
  CHECK(desk.browser.evaluate(plots) == "speed,pitch,currents,heading");
  // no drag: a press, which takes the plot away
  desk.browser.mouse("mousePressed", reading[0], reading[1]);
  desk.browser.mouse("mouseReleased", reading[0], reading[1]);
  CHECK(desk.browser.evaluate(plots) == "speed,pitch,currents");
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: the axis of a plot has round numbers, and a heading goes on over half a turn") {
  Desk desk;
  desk.browser.evaluate("import('/signals.js').then((all) => { window.signals = all; return 0; })");
  CHECK(desk.browser.evaluate("signals.axisOf({ least: 0.5, zero: true }, [[0, 0.25], [1, 0.31]])") ==
        json::parse(R"({"low": 0, "high": 0.6, "ticks": [0, 0.2, 0.4, 0.6]})"));
  CHECK(desk.browser.evaluate("signals.axisOf({ least: 10, zero: true }, [[0, -3, 42]]).low") == -20);
  CHECK(desk.browser.evaluate("signals.axisOf({ least: 10, zero: true }, [[0, -3, 42]]).high") == 60);
  CHECK(desk.browser.evaluate("signals.axisOf({ least: 1 }, [[0, 25.9], null, [1, 25.9]]).low") < 25.9);
  // 170, 179, -178 and -170 degrees, by their quaternions about z; then the robot was away
  CHECK(
      desk.browser.evaluate(
          "signals.rowsOf(signals.SIGNALS.heading, [170, 179, -178, null, -170].map((deg, t) => ({ t, gap: false,"
          "  robots: new Map(deg === null ? [] : [[1, { now: { q: [Math.cos(deg * Math.PI / 360), 0, 0, Math.sin(deg * "
          "Math.PI / 360)] } }]]) })), 1).map((row) => row && Math.round(row[1]))") ==
      json::parse("[170, 179, 182, null, -170]"));
}

}  // namespace kenaf::live
