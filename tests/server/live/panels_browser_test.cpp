// The page's pictures and choices, in a real browser: a camera's picture takes the world's place, full screen, the list
// of worlds, a gamepad, what a reload keeps, and a picture that is drawn better again.
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <string>

#include "tests/server/live/browser_desk.hpp"
#include "tests/support/usarsim_client.hpp"

namespace kenaf::live {

using nlohmann::json;

namespace {

void tap(Browser& browser, std::string_view code) {
  browser.key(code, true);
  browser.key(code, false);
}

constexpr const char* kTwoPictures =
    "document.querySelectorAll('#pictures img').length === 2 && "
    "[...document.querySelectorAll('#pictures img')].every((picture) => picture.naturalWidth > 0)";
// What fills the place of the large picture: a camera's name, or "3D".
constexpr const char* kLarge = "(document.querySelector('#view > figure')?.dataset.camera ?? '3D')";

// A gamepad of the browser's standard layout, which the test presses: pad.buttons[4] is the left shoulder.
void plug_in_gamepad(Browser& browser) {
  browser.evaluate(
      "window.pad = { id: 'A pad', connected: true, mapping: 'standard', axes: [0, 0, 0, 0],"
      "  buttons: Array.from({ length: 17 }, () => ({ pressed: false })) }, navigator.getGamepads = () => [null, pad], "
      "0");
}
// The page looks every 50 ms; two of its looks are over after this.
void let_it_look(Browser& browser) {
  browser.evaluate(
      "new Promise((done) => { let looks = 0; navigator.getGamepads = () => { if (++looks === 3) done(0); return "
      "[pad]; "
      "}; })");
}

}  // namespace

TEST_CASE("In a browser: a camera's picture that is clicked takes the world's place, and Escape gives it back") {
  Desk desk;
  desk.place();
  desk.browser.wait_for(kTwoPictures);
  desk.browser.click("#pictures figure:nth-child(2)");
  CHECK(desk.browser.evaluate(kLarge) == "BirdsEye");
  CHECK(desk.browser.evaluate("document.querySelector('#view > figure').offsetWidth > innerWidth / 2") == true);
  CHECK(desk.browser.evaluate("document.getElementById('canvas').closest('#pictures') !== null") == true);
  // it goes on, and the robot drives
  desk.browser.wait_for("/ ms$/.test(document.querySelector('#view > figure output').textContent)");
  desk.browser.key("KeyW", true);
  desk.robot_with(drives);
  desk.browser.key("KeyW", false);
  // the world, small, is a button too
  desk.browser.click("#small-world");
  CHECK(desk.browser.evaluate(kLarge) == "3D");
  CHECK(desk.browser.evaluate("document.getElementById('canvas').parentElement.id") == "view");

  // by key: one after the other, and by Escape back, which does not let go of the robot
  tap(desk.browser, "KeyZ");
  CHECK(desk.browser.evaluate(kLarge) == "Camera");
  tap(desk.browser, "KeyZ");
  CHECK(desk.browser.evaluate(kLarge) == "BirdsEye");
  tap(desk.browser, "KeyX");
  CHECK(desk.browser.evaluate("document.body.hasAttribute('data-full')") == true);
  CHECK(desk.browser.evaluate("document.querySelector('header').checkVisibility()") == false);
  CHECK(desk.browser.evaluate("document.querySelector('#view > figure').offsetWidth > 0.95 * innerWidth") == true);
  CHECK(desk.browser.evaluate("document.getElementById('drive-state').checkVisibility()") == true);
  tap(desk.browser, "Escape");
  CHECK(desk.browser.evaluate("document.body.hasAttribute('data-full')") == false);
  CHECK(desk.browser.evaluate(kLarge) == "BirdsEye");
  tap(desk.browser, "Escape");
  CHECK(desk.browser.evaluate(kLarge) == "3D");
  CHECK(desk.state_now() == "held");
  tap(desk.browser, "Escape");
  desk.state_is("none");
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: who measures sees the world, and is told that the robot stands meanwhile") {
  Desk desk;
  desk.place();
  desk.browser.wait_for(kTwoPictures);
  const auto measures = [&] {
    return desk.browser.evaluate("document.getElementById('measure').getAttribute('aria-pressed')") == "true";
  };
  tap(desk.browser, "KeyZ");
  CHECK(desk.browser.evaluate(kLarge) == "Camera");
  tap(desk.browser, "KeyM");
  CHECK(desk.browser.evaluate(kLarge) == "3D");
  CHECK(measures());
  desk.browser.wait_for(
      "document.getElementById('drive-state').textContent === "
      "'Manual1 stands: you point at a place now. Esc ends that'");
  tap(desk.browser, "KeyZ");  // a picture that is enlarged ends it
  CHECK_FALSE(measures());
  desk.state_is("held");
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: the large camera is large again after a reload, and when its pictures come back") {
  Desk desk;
  desk.place();
  desk.browser.wait_for(kTwoPictures);
  tap(desk.browser, "KeyZ");
  CHECK(desk.browser.evaluate(kLarge) == "Camera");
  const auto hide = [&](bool hidden) {
    desk.browser.evaluate(std::string("Object.defineProperty(document, 'hidden', { value: ") +
                          (hidden ? "true" : "false") +
                          ", configurable: true }); document.dispatchEvent(new Event('visibilitychange')), 0");
  };
  hide(true);
  CHECK(desk.browser.evaluate("document.getElementById('canvas').parentElement.id") == "view");
  tap(desk.browser, "KeyZ");  // there is no picture to enlarge
  CHECK(desk.browser.evaluate(kLarge) == "3D");
  hide(false);
  desk.browser.wait_for(std::string(kLarge) + " === 'Camera'");
  desk.browser.evaluate("window.was_open = true, setTimeout(() => location.reload(), 50), 0");
  desk.browser.wait_for("!window.was_open && " + std::string(kLarge) + " === 'Camera'");
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser without WebGL a camera's picture is large among the others, and full screen") {
  Desk desk({"--disable-3d-apis"});
  desk.place();
  desk.browser.wait_for("document.body.dataset.view === 'cameras'");
  desk.browser.wait_for(kTwoPictures);
  const std::string widths = "[...document.querySelectorAll('#pictures figure')].map((figure) => figure.offsetWidth)";
  const json before = desk.browser.evaluate(widths);
  CHECK(std::abs(before[0].get<int>() - before[1].get<int>()) <= 1);
  desk.browser.click("#pictures figure:nth-child(2)");
  const json after = desk.browser.evaluate(widths);
  CHECK(after[1] > 1.9 * before[1].get<int>());
  tap(desk.browser, "KeyX");
  CHECK(desk.browser.evaluate(
            "document.querySelector('#pictures figure[data-large]').offsetWidth > 0.95 * innerWidth") == true);
  tap(desk.browser, "Escape");
  tap(desk.browser, "Escape");
  CHECK(desk.browser.evaluate(widths) == before);
  CHECK(desk.state_now() == "held");
}

TEST_CASE("In a browser: the list of worlds tells the command that starts each, and drives nothing meanwhile") {
  Desk desk;
  desk.place();
  desk.browser.key("KeyW", true);
  desk.state_is("driving");
  desk.browser.click("#world");
  desk.browser.wait_for("document.getElementById('worlds').open");
  CHECK(desk.state_now() == "held");
  desk.browser.key("KeyW", false);
  CHECK(desk.browser.evaluate("document.getElementById('worlds-list').selectedOptions[0].text") ==
        "step-200 (running)");
  desk.browser.evaluate(
      "(() => { const list = document.getElementById('worlds-list'); list.value = 'stairs';"
      "  list.dispatchEvent(new Event('change')); })()");
  CHECK(desk.browser.evaluate("document.getElementById('worlds-about').textContent")
            .get<std::string>()
            .starts_with("12 steps of 75 mm rise"));
  CHECK(desk.browser.evaluate("document.getElementById('worlds-command').textContent") ==
        "kenaf-world --world stairs --view 127.0.0.1:" + std::to_string(desk.world.port()));
  // the smaller step before the larger one
  CHECK(
      desk.browser.evaluate("(() => { const names = [...document.getElementById('worlds-list').options].map((each) => "
                            "each.value); return names.indexOf('step-50') < names.indexOf('step-200'); })()") == true);
  desk.browser.click("#worlds-close");
  CHECK(desk.browser.evaluate("document.getElementById('worlds').open") == false);
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: what is still pressed drives no other robot once one's own has left") {
  Desk desk;
  plug_in_gamepad(desk.browser);
  auto program = std::make_unique<support::UsarsimClient>(desk.world.usarsim_port());
  program->send("INIT {ClassName USARBot.Kenaf} {Name R1} {Location 0,0,0}\r\n");
  desk.browser.wait_for("document.getElementById('robot').options.length === 1");
  support::UsarsimClient other(desk.world.usarsim_port());
  other.send("INIT {ClassName USARBot.Kenaf} {Name R2} {Location 0,3,0}\r\n");
  desk.browser.wait_for("document.getElementById('robot').options.length === 2");
  tap(desk.browser, "KeyT");
  desk.state_is("held");
  let_it_look(desk.browser);
  desk.browser.evaluate("pad.axes[1] = -1, pad.buttons[4].pressed = true, 0");
  desk.state_is("driving");

  program.reset();
  desk.browser.wait_for("document.getElementById('notice').textContent === 'R1 left the world'");
  tap(desk.browser, "KeyT");
  desk.state_is("held");
  let_it_look(desk.browser);
  CHECK(desk.state_now() == "held");
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: a gamepad drives while its dead-man is held, and Space stands the robot nevertheless") {
  Desk desk;
  plug_in_gamepad(desk.browser);
  desk.browser.evaluate("pad.axes[1] = -1, pad.buttons[4].pressed = true, 0");
  desk.place();
  // held since before the robot was there
  let_it_look(desk.browser);
  CHECK(desk.state_now() == "held");
  const auto dead_man = [&](bool down) {
    desk.browser.evaluate(std::string("pad.buttons[4].pressed = ") + (down ? "true" : "false"));
    let_it_look(desk.browser);
  };
  dead_man(false);
  dead_man(true);
  desk.state_is("driving");
  desk.robot_with(drives);

  tap(desk.browser, "Space");
  CHECK(desk.state_now() == "held");
  desk.robot_with(stands);
  let_it_look(desk.browser);
  CHECK(desk.state_now() == "held");  // though the dead-man is held
  dead_man(false);
  dead_man(true);
  desk.state_is("driving");

  // so does B, a question, and looking back
  desk.browser.evaluate("pad.buttons[1].pressed = true");
  desk.state_is("held");
  desk.browser.evaluate("pad.buttons[1].pressed = false");
  dead_man(false);
  dead_man(true);
  desk.state_is("driving");
  tap(desk.browser, "Comma");
  desk.state_is("paused");
  desk.robot_with(stands);
  tap(desk.browser, "End");
  let_it_look(desk.browser);
  CHECK(desk.state_now() == "held");

  // flippers while a button is held; unplugged, nothing is
  desk.browser.evaluate("pad.buttons[12].pressed = true");
  desk.robot_with([](const json& robot) { return robot["command"]["flipper"][0][0] == "speed"; });
  dead_man(false);
  dead_man(true);
  desk.state_is("driving");
  desk.browser.evaluate("navigator.getGamepads = () => [], 0");
  desk.state_is("held");
  desk.robot_with(stands);
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: a reload keeps the chosen robot and the pace") {
  Desk desk;
  for (const char* name : {"Manual1", "Manual2"}) {
    desk.place();
    desk.browser.wait_for(std::string("document.getElementById('robot').selectedOptions[0]?.text === '") + name + "'");
  }
  desk.browser.evaluate(
      "(() => { const pace = document.getElementById('pace'); pace.value = 80; pace.dispatchEvent(new Event('input')); "
      "})()");
  desk.browser.evaluate("window.was_open = true, setTimeout(() => location.reload(), 50), 0");
  desk.browser.wait_for("!window.was_open && document.getElementById('robot')?.selectedOptions[0]?.text === 'Manual2'");
  CHECK(desk.browser.evaluate("document.getElementById('pace').value") == "80");
  // a browser that keeps nothing has a page all the same
  desk.browser.evaluate(
      "import('/kept.js').then((kept) => { Object.defineProperty(window, 'localStorage', { get() { throw new Error(); "
      "} });"
      "  kept.keep('pace', 1); window.recalled = kept.recall('pace'); return 0; })");
  CHECK(desk.browser.evaluate("recalled") == nullptr);
}

TEST_CASE("In a browser: a picture that takes long is drawn more simply, and in full again once there is time") {
  Desk desk;
  desk.browser.evaluate(
      "import('/picture_quality.js').then((all) => { window.make = all.createPictureQuality; return 0; })");
  // The level after so many pictures that take `ms` each, 20 of them in a second of the caller's clock.
  desk.browser.evaluate(
      "window.quality = make(4), window.clock_ms = 0,"
      "window.draw = (seconds, ms) => { for (let i = 0; i < 20 * seconds; ++i) quality.took(ms, clock_ms += 50); "
      "return "
      "quality.level; }, 0");
  CHECK(desk.browser.evaluate("draw(2, 10)") == 0);
  CHECK(desk.browser.evaluate("draw(10, 100)") == 3);
  CHECK(desk.browser.evaluate("draw(60, 30)") == 3);  // not slow, but four times that would be
  CHECK(desk.browser.evaluate("draw(4, 5)") == 2);    // the last change was long ago: one level at once
  CHECK(desk.browser.evaluate("draw(20, 5)") == 0);
  // a better picture that is too much: the next tries are rarer
  const auto tries = [&](int seconds) {
    return desk.browser
        .evaluate("(() => { let tries = 0; for (let i = 0; i < 20 * " + std::to_string(seconds) +
                  "; ++i) { const before = quality.level; quality.took(quality.level < 1 ? 100 : 5, clock_ms += 50);"
                  "  if (quality.level < before) ++tries; } return tries; })()")
        .get<int>();
  };
  const int at_first = tries(60), later = tries(60);
  CHECK(at_first >= 2);
  CHECK(later < at_first);
}

}  // namespace kenaf::live
