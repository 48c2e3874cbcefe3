// Keys and clicks that must do no harm, in a real browser: Space means stand wherever the focus is, Enter presses no
// button while somebody drives, and what cannot be undone asks first and does not move under the pointer.
#include <catch2/catch.hpp>

#include "tests/server/live/browser_desk.hpp"

namespace kenaf::live {

using nlohmann::json;

namespace {

void press(Browser& browser, std::string_view code) {
  browser.key(code, true);
  browser.key(code, false);
}

struct Point {
  double x, y;
};

Point middle_of(Browser& browser, const std::string& id) {
  const json box = browser.evaluate("(() => { const box = document.getElementById('" + id +
                                    "').getBoundingClientRect();"
                                    "  return [box.x + box.width / 2, box.y + box.height / 2]; })()");
  return {box[0], box[1]};
}

void click(Browser& browser, Point at, int count = 1) {
  browser.mouse("mouseMoved", at.x, at.y);
  for (int i = 1; i <= count; ++i) {
    browser.mouse("mousePressed", at.x, at.y, i);
    browser.mouse("mouseReleased", at.x, at.y, i);
  }
}

std::size_t robot_count(Desk& desk) {
  WebClient witness(desk.world.port());
  REQUIRE(witness.open_websocket());
  return witness.message_of("state")["robots"].size();
}

std::string focus(Browser& browser) {
  return browser.evaluate("document.activeElement.id");
}

}  // namespace

TEST_CASE("In a browser: after a robot is placed, Space, Enter and a double click place no other") {
  Desk desk;
  click(desk.browser, middle_of(desk.browser, "place"), 2);
  press(desk.browser, "Enter");
  desk.state_is("held");
  CHECK(focus(desk.browser) == "stick");
  for (const char* code : {"Space", "Enter"}) press(desk.browser, code);
  // by the keyboard too, with the button's own focus
  desk.browser.evaluate("document.getElementById('place').focus()");
  press(desk.browser, "Space");
  desk.browser.key("KeyW", true);
  desk.state_is("driving");
  CHECK(focus(desk.browser) == "stick");
  press(desk.browser, "Enter");
  desk.browser.key("KeyW", false);
  desk.robot_with(stands);
  CHECK(robot_count(desk) == 1);
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: Space stands, wherever the focus is, and what is still down drives no more") {
  Desk desk;
  desk.place();
  for (const char* element : {"stick", "place", "remove", "pause", "reset", "speed", "pace", "view-follow", "let-go"}) {
    INFO(element);
    desk.browser.evaluate("document.getElementById('stick').focus()");
    desk.browser.key("KeyW", true);
    desk.robot_with(drives);
    // not by focus(), which a list takes for its opening
    desk.browser.evaluate(std::string("document.getElementById('") + element + "').focus(), 0");
    if (std::string(element) == "speed") desk.browser.key("KeyW", false);
    press(desk.browser, "Space");
    desk.state_is("held");
    desk.robot_with(stands);
    CHECK(desk.state_now() == "held");  // though W is down
    desk.browser.key("KeyW", false);
  }
  CHECK(robot_count(desk) == 1);
  CHECK(desk.browser.evaluate("document.querySelector('dialog[open]')") == nullptr);
  CHECK(desk.browser.evaluate("document.getElementById('pause').textContent") == "Pause");
  // flippers under way stop as well
  desk.browser.key("Digit1", true);
  desk.robot_with([](const json& robot) { return robot["command"]["flipper"][0][0] == "angle"; });
  press(desk.browser, "Space");
  desk.robot_with([](const json& robot) { return robot["command"]["flipper"][0][0] == "brake"; });
  desk.browser.key("Digit1", false);
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: with Shift the keys drive slowly") {
  Desk desk;
  desk.place();
  desk.browser.key("KeyW", true);
  const double fast = desk.robot_with(drives)["command"]["track"][0];
  desk.browser.key("ShiftLeft", true);
  desk.robot_with([&](const json& robot) { return robot["command"]["track"][0] == Approx(0.3 * fast).margin(1e-3); });
  // Still slowly after Space, though Shift says nothing anew.
  press(desk.browser, "Space");
  desk.robot_with(stands);
  desk.browser.key("KeyW", false);
  desk.browser.key("KeyW", true);
  desk.robot_with([&](const json& robot) { return robot["command"]["track"][0] == Approx(0.3 * fast).margin(1e-3); });
  desk.browser.key("ShiftLeft", false);
  desk.robot_with([&](const json& robot) { return robot["command"]["track"][0] == Approx(fast).margin(1e-3); });
  desk.browser.key("KeyW", false);
  desk.robot_with(stands);
}

TEST_CASE("In a browser: what cannot be undone asks, and a double click on it answers nothing") {
  Desk desk;
  desk.place();
  for (const auto& [button, word] :
       {std::pair{"remove", "Remove Manual1"}, std::pair{"reset", "Reset the whole world"}}) {
    INFO(button);
    const Point at = middle_of(desk.browser, button);
    click(desk.browser, at, 2);
    desk.browser.wait_for("document.getElementById('question').open");
    CHECK(
        desk.browser.evaluate("document.getElementById('question-words').textContent").get<std::string>().find(word) ==
        0);
    CHECK(focus(desk.browser) == "question-no");
    // Enter answers with no
    press(desk.browser, "Enter");
    desk.browser.wait_for("!document.getElementById('question').open");
    CHECK(robot_count(desk) == 1);
  }
  // nothing drives while it is asked, and yes does it
  click(desk.browser, middle_of(desk.browser, "remove"));
  desk.browser.wait_for("document.getElementById('question').open");
  desk.browser.key("KeyW", true);
  CHECK(desk.state_now() == "held");
  desk.browser.key("KeyW", false);
  desk.browser.wait_for("!document.getElementById('question-yes').disabled");
  click(desk.browser, middle_of(desk.browser, "question-yes"));
  desk.browser.wait_for("document.getElementById('robot').options.length === 0");
  CHECK(robot_count(desk) == 0);
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: no button moves when a robot comes, is taken, is let go of, or goes") {
  Desk desk;
  const std::string places =
      "JSON.stringify([...document.querySelectorAll('#robot-buttons button, #time-controls button')].map((button) => {"
      "  const box = button.getBoundingClientRect(); return [button.id, box.x, box.y, box.width, box.height]; }))";
  // as wide as it gets, so that the time's figures move nothing either
  const std::string at_first = desk.browser.evaluate(places);
  desk.place();
  CHECK(desk.browser.evaluate(places) == at_first);
  desk.browser.key("KeyW", true);
  desk.state_is("driving");
  CHECK(desk.browser.evaluate(places) == at_first);
  desk.browser.key("KeyW", false);
  press(desk.browser, "Escape");
  desk.state_is("none");
  CHECK(desk.browser.evaluate(places) == at_first);
  desk.browser.evaluate("document.getElementById('pause').click()");
  desk.browser.wait_for("document.getElementById('pause').textContent === 'Resume'");
  CHECK(desk.browser.evaluate(places) == at_first);
}

TEST_CASE("In a browser: the question mark opens the list of keys and closes it") {
  Desk desk;
  desk.place();
  desk.browser.key("Slash", true, "?");
  desk.browser.key("Slash", false, "?");
  desk.browser.wait_for("document.getElementById('help').open");
  CHECK(desk.browser.evaluate("document.getElementById('help').scrollTop") == 0);
  desk.browser.key("KeyW", true);
  CHECK(desk.state_now() == "held");
  desk.browser.key("KeyW", false);
  desk.browser.key("Slash", true, "?");
  desk.browser.key("Slash", false, "?");
  desk.browser.wait_for("!document.getElementById('help').open");
  // every key that drives or turns is in it
  const json missing = desk.browser.evaluate(
      "[...'WASDQERF1234JLIKUOCTP?56789NBYM,.'].filter((key) => ![...document.querySelectorAll('#help "
      "kbd')].some((kbd) => "
      "kbd.textContent === key))");
  CHECK(missing == json::array());
}

}  // namespace kenaf::live
