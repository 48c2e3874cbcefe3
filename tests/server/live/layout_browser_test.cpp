// What the page looks like, in a real browser: on a desk, on a phone upright and on its side, light and dark.
// page_checks.js has what is wrong in a page. The pictures are kept beside the test's program, in live-view/.
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/server/live/browser_desk.hpp"

namespace kenaf::live {

namespace {

struct Size {
  int width, height;
  bool phone;
};
constexpr Size kSizes[] = {{1280, 720, false}, {1440, 900, false}, {844, 390, true}, {390, 844, true}};

void load_checks(Browser& browser) {
  std::ifstream file(KENAF_PAGE_CHECKS);
  browser.evaluate(std::string(std::istreambuf_iterator<char>(file), {}) + ", 0");
}

// The stick and all buttons that drive are on the screen without scrolling.
constexpr const char* kHandIsOnScreen =
    "[...document.querySelectorAll('#stick, [data-hold], #robot-buttons button, #drive-state')].every((e) => {"
    "  const box = e.getBoundingClientRect();"
    "  return box.top >= 0 && box.left >= 0 && box.bottom <= innerHeight && box.right <= innerWidth; })";

void check_all_sizes(Desk& desk, const std::string& name) {
  load_checks(desk.browser);
  for (const auto& [width, height, phone] : kSizes) {
    desk.browser.resize(width, height, phone);
    desk.browser.wait_for("innerWidth === " + std::to_string(width));
    for (const bool dark : {false, true}) {
      desk.browser.set_dark(dark);
      desk.browser.wait_for(std::string("matchMedia('(prefers-color-scheme: dark)').matches === ") +
                            (dark ? "true" : "false"));
      INFO(name << ' ' << width << 'x' << height << (dark ? ", dark" : ", light"));
      const auto none = nlohmann::json::array();
      CHECK(desk.browser.evaluate("overlaps()") == none);
      CHECK(desk.browser.evaluate("pale()") == none);
      CHECK(desk.browser.evaluate("nameless()") == none);
      CHECK(desk.browser.evaluate("small()") == none);
      CHECK(desk.browser.evaluate("underAlarm()") == none);
      CHECK(desk.browser.evaluate(kHandIsOnScreen) == true);
      desk.browser.screenshot(desk.pictures / (name + "-" + std::to_string(width) + "x" + std::to_string(height) +
                                               (dark ? "-dark.png" : "-light.png")));
    }
  }
}

constexpr const char* kHasPictures =
    "document.querySelectorAll('#pictures img').length === 2 && "
    "[...document.querySelectorAll('#pictures img')].every((picture) => picture.naturalWidth > 0)";

}  // namespace

TEST_CASE("In a browser: nothing covers anything, all text is readable and the hand is on the screen, at four sizes") {
  Desk desk;
  check_all_sizes(desk, "empty");
  desk.place();
  desk.browser.wait_for(kHasPictures);
  check_all_sizes(desk, "driving");
  desk.browser.evaluate("document.getElementById('help-open').click()");
  load_checks(desk.browser);
  CHECK(desk.browser.evaluate("pale()") == nlohmann::json::array());
  CHECK(desk.browser.evaluate("nameless()") == nlohmann::json::array());
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: so it is while one looks back, with more plots, with a camera large, and full screen") {
  Desk desk;
  desk.place();
  desk.browser.wait_for(kHasPictures);
  desk.browser.wait_for("parseFloat(document.getElementById('time').textContent) > 1.5");
  const auto tap = [&](std::string_view code) {
    desk.browser.key(code, true);
    desk.browser.key(code, false);
  };
  desk.browser.evaluate(
      "[...document.querySelectorAll('button.reading')].filter((each) => ['Angles', "
      "'Place'].includes(each.textContent))"
      ".forEach((each) => each.click())");
  tap("Comma");
  desk.state_is("paused");
  check_all_sizes(desk, "past");
  tap("End");
  tap("KeyZ");
  check_all_sizes(desk, "camera-large");
  tap("KeyX");
  check_all_sizes(desk, "full-screen");
  tap("Escape");
  desk.browser.click("#world");
  desk.browser.wait_for("document.getElementById('worlds').open");
  load_checks(desk.browser);
  CHECK(desk.browser.evaluate("pale()") == nlohmann::json::array());
  CHECK(desk.browser.evaluate("nameless()") == nlohmann::json::array());
  desk.browser.screenshot(desk.pictures / "worlds.png");
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser without WebGL the cameras take the place of the 3D view") {
  Desk desk({"--disable-3d-apis"});
  desk.place();
  desk.browser.wait_for(kHasPictures);
  desk.browser.wait_for("document.body.dataset.view === 'cameras' && document.getElementById('notice').hidden");
  // where the view was, and as wide
  CHECK(desk.browser.evaluate("document.getElementById('view')") == nullptr);
  CHECK(desk.browser.evaluate("document.getElementById('pictures').getBoundingClientRect().left < 20") == true);
  CHECK(desk.browser.evaluate("document.getElementById('pictures').offsetWidth > innerWidth / 2") == true);
  desk.browser.key("KeyW", true);
  desk.robot_with(drives);
  desk.browser.key("KeyW", false);
  desk.robot_with(stands);
  check_all_sizes(desk, "cameras");  // last: a page that draws for longer than 10 s lets its robot go
  desk.browser.key("KeyZ", true);
  desk.browser.key("KeyZ", false);
  check_all_sizes(desk, "cameras-large");
}

}  // namespace kenaf::live
