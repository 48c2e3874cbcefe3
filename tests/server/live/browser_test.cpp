// A person at the page, in a real browser: keys held, the robot drives; let go of, it stands. The pictures are kept
// beside the test's program, in live-view/.
//
// What the robot does is asked of the world server by a second page, not of the browser that drives.
#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <thread>

#include "tests/server/live/browser_desk.hpp"
#include "tests/support/usarsim_client.hpp"

namespace kenaf::live {

using nlohmann::json;

TEST_CASE("In a browser: keys held drive the robot, letting go of them stops it, and so does looking away") {
  Desk desk;
  desk.place();
  CHECK(desk.browser.evaluate("document.getElementById('stick').checkVisibility()") == true);

  desk.browser.key("KeyW", true);
  desk.state_is("driving");
  desk.robot_with(drives);
  desk.browser.key("KeyW", false);
  desk.state_is("held");
  const json stopped = desk.robot_with(stands);
  CHECK(stopped["p"][0] > 0.005);

  // flippers: up while the key is held
  const double before = stopped["flipper"][0];
  desk.browser.key("KeyQ", true);
  desk.robot_with([&](const json& robot) { return robot["flipper"][0] > before + 0.2; });
  desk.browser.key("KeyQ", false);
  desk.robot_with([](const json& robot) { return robot["command"]["flipper"][0][0] == "brake"; });

  // the window loses the focus while the key is down
  desk.browser.key("ArrowUp", true);
  desk.robot_with(drives);
  desk.browser.evaluate("dispatchEvent(new Event('blur')), 0");
  desk.state_is("held");
  desk.robot_with(stands);

  desk.browser.wait_for("document.querySelector('#readings dd').textContent.endsWith('\u00b0')");
  desk.browser.screenshot(desk.pictures / "desktop.png");
  desk.browser.set_dark(true);
  desk.browser.resize(390, 844, true);
  desk.browser.wait_for("innerWidth === 390");
  // nothing is wider than the phone
  CHECK(desk.browser.evaluate("document.documentElement.scrollWidth") <= 390);
  desk.browser.screenshot(desk.pictures / "phone-dark.png");

  desk.browser.key("Escape", true);
  desk.browser.key("Escape", false);
  desk.state_is("none");
  desk.robot_with([](const json& robot) { return !robot.contains("holder"); });
  CHECK(desk.browser.complaints().empty());
  for (const std::string& complaint : desk.browser.complaints()) UNSCOPED_INFO(complaint);
}

TEST_CASE("In a browser: a page that was open shows the world of the server that is started next") {
  support::TemporaryFolder profile;
  Browser browser(profile.path());  // before the world: what it is started from is what it keeps open
  auto world = std::make_unique<ServedWorld>("", ViewLimits{}, "step-200");
  browser.open(world->url());
  const std::string shows = "document.getElementById('link')?.dataset.state === 'good' && ";
  browser.wait_for(shows + "document.getElementById('world').textContent === 'step-200'");
  browser.evaluate("window.was_open = true");
  const std::uint16_t port = world->port();
  world.reset();
  world = std::make_unique<ServedWorld>("", ViewLimits{}, "flat", port);
  browser.wait_for(shows + "document.getElementById('world').textContent === 'flat' && !window.was_open");
}

TEST_CASE("In a browser: both cameras' pictures are shown, turned by keys, and not fetched by a hidden page") {
  Desk desk;
  desk.place();
  // both are there, whole, and show something: their middle row has many colours
  const char* shown =
      "(() => { const pictures = [...document.querySelectorAll('#pictures img')];"
      "  return pictures.length === 2 && pictures.every((picture) => {"
      "    const { naturalWidth: width, naturalHeight: height } = picture;"
      "    if (!width) return false;"
      "    const canvas = document.createElement('canvas'); canvas.width = width; canvas.height = height;"
      "    const context = canvas.getContext('2d'); context.drawImage(picture, 0, 0);"
      "    const pixels = context.getImageData(width / 2, 0, 1, height).data;"
      "    return new Set(Array.from({ length: height }, (_, row) => pixels[4 * row])).size > 20; }); })()";
  desk.browser.wait_for(shown);
  const char* ages = "[...document.querySelectorAll('#pictures output')].every((age) => / ms$/.test(age.textContent))";
  desk.browser.wait_for(ages);

  // while L is held the camera turns to the right: a negative pan
  const auto camera = [](const json& robot) { return robot["cameras"][0]; };
  desk.browser.key("KeyL", true);
  desk.robot_with([&](const json& robot) { return camera(robot)["pan"] < -0.2; });
  desk.browser.key("KeyL", false);
  desk.browser.key("KeyU", true);
  desk.robot_with([&](const json& robot) { return camera(robot)["fov"] < 0.9; });
  desk.browser.key("KeyU", false);
  desk.browser.key("KeyC", true);
  desk.robot_with([&](const json& robot) { return camera(robot)["pan"] == 0; });
  desk.browser.key("KeyC", false);
  // the slider, by the keyboard: right is right
  desk.browser.evaluate("document.getElementById('look-pan').focus()");
  for (int i = 0; i < 3; ++i) {
    desk.browser.key("ArrowRight", true);
    desk.browser.key("ArrowRight", false);
  }
  desk.robot_with([&](const json& robot) { return camera(robot)["pan"] < -0.04; });
  desk.robot_with([&](const json& robot) {
    return robot["track_mps"][0] == 0 || std::abs(robot["track_mps"][0].get<double>()) < 0.01;
  });

  // a page that nobody sees has nothing drawn
  desk.browser.evaluate(
      "Object.defineProperty(document, 'hidden', { value: true, configurable: true }); document.dispatchEvent(new "
      "Event('visibilitychange')), 0");
  for (int i = 0; i < 2000 && !desk.world.cameras().newest().empty(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  CHECK(desk.world.cameras().newest().empty());
  desk.browser.evaluate("delete document.hidden; document.dispatchEvent(new Event('visibilitychange')), 0");
  desk.browser.wait_for(shown);
  CHECK(desk.browser.complaints().empty());
  for (const std::string& complaint : desk.browser.complaints()) UNSCOPED_INFO(complaint);
}

TEST_CASE(
    "In a browser: a picture is drawn in half its size where its place is that small, and whole where it is large") {
  Desk desk;
  desk.place();
  const auto size_is = [&](const std::string& picture, const std::string& size) {
    desk.browser.wait_for(
        "(({ naturalWidth, naturalHeight }) => naturalWidth + 'x' + naturalHeight)(document.querySelector('" + picture +
        " img')) === '" + size + "'");
  };
  size_is("#pictures figure:nth-child(1)", "320x240");
  size_is("#pictures figure:nth-child(2)", "320x240");
  desk.browser.click("#pictures figure:nth-child(2)");
  size_is("#view > figure", "640x480");
  size_is("#pictures figure:nth-child(1)", "320x240");
  const char* age = "/^[0-9]+ ms$/.test(document.querySelector('#view > figure output').textContent)";
  desk.browser.wait_for(age);
  desk.browser.click("#small-world");
  size_is("#pictures figure:nth-child(2)", "320x240");
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: of two robots of one name each shows its own pictures") {
  Desk desk;
  support::UsarsimClient one(desk.world.usarsim_port()), two(desk.world.usarsim_port());
  one.send("INIT {ClassName USARBot.Kenaf} {Name Kenaf} {Location 0,0,0}\r\n");
  two.send("INIT {ClassName USARBot.Kenaf} {Name Kenaf} {Location 0,3,0}\r\n");
  desk.browser.wait_for("document.getElementById('robot').options.length === 2");
  const std::string shown = "document.querySelector('#pictures img')?.naturalWidth > 0";
  const auto address = [&] {
    return desk.browser.evaluate("document.querySelector('#pictures img').dataset.stream").get<std::string>();
  };
  desk.browser.wait_for(shown);
  const std::string first = address();
  desk.browser.evaluate(
      "(() => { const list = document.getElementById('robot'); list.selectedIndex = 1;"
      "  list.dispatchEvent(new Event('change')); })()");
  desk.browser.wait_for(shown + " && document.querySelector('#pictures img').dataset.stream !== '" + first + "'");
  const std::string second = address();
  CHECK(first.find("/camera/%23") != std::string::npos);
  CHECK(second.find("/camera/%23") != std::string::npos);
}

TEST_CASE(
    "In a browser, with the keyboard alone: a robot is taken over from its program by the buttons in their order") {
  Desk desk;
  support::UsarsimClient program(desk.world.usarsim_port());
  program.send("INIT {ClassName USARBot.Kenaf} {Name <b>R1</b>} {Location 0,0,0}\r\nDRIVE {Left 1} {Right 1}\r\n");
  desk.browser.wait_for("document.getElementById('robot').options.length === 1");
  CHECK(desk.browser.evaluate("document.getElementById('robot').options[0].text") == "<b>R1</b>");
  // every control has a name, and Tab reaches those that can be used
  CHECK(
      desk.browser.evaluate(
          "[...document.querySelectorAll('button, select, input')].filter((e) => e.checkVisibility() && !e.disabled && "
          "!(e.textContent.trim() || e.labels?.length)).length") == 0);
  for (int presses = 0; desk.browser.evaluate("document.activeElement.id") != "take"; ++presses) {
    REQUIRE(presses < 40);
    desk.browser.key("Tab", true);
    desk.browser.key("Tab", false);
  }
  desk.browser.key("KeyT", true);
  desk.browser.key("KeyT", false);
  desk.state_is("held");
  desk.robot_with(stands);
  program.send("DRIVE {Left 1} {Right 1}\r\n");
  desk.browser.key("KeyS", true);
  desk.robot_with([](const json& robot) { return robot["track_mps"][0] < -0.1; });
  desk.browser.key("KeyS", false);
  desk.robot_with(stands);
  CHECK(desk.browser.complaints().empty());
}

}  // namespace kenaf::live
