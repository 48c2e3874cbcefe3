// What the page holds down and says, in a real browser: when it lets go by itself, and how much it sends.
#include <catch2/catch.hpp>

#include "tests/server/live/browser_desk.hpp"

namespace kenaf::live {

namespace {

// From now on `sent` holds what the page sends, and `socket` is where; `news()` is the next message from there.
void watch_words(Browser& browser) {
  browser.evaluate(
      "(() => { const send = WebSocket.prototype.send; window.sent = []; WebSocket.prototype.send = function (text) {"
      "  window.socket = this; sent.push(JSON.parse(text)); send.call(this, text); }; })()");
  browser.wait_for("window.socket");  // a ping comes once a second
  browser.evaluate(
      "window.news = () => new Promise((done) => socket.addEventListener('message', done, { once: true })), 0");
}

void wait_300_ms(Browser& browser) {
  browser.evaluate("new Promise((done) => setTimeout(done, 300))");
}

}  // namespace

TEST_CASE(
    "In a browser: a menu, a list and a question let go of the keys, as they keep a key's release to themselves") {
  Desk desk;
  desk.place();
  const auto drive = [&] {
    desk.browser.key("KeyW", true);
    desk.state_is("driving");
  };
  for (const char* opens :
       {"document.body.dispatchEvent(new MouseEvent('contextmenu', { bubbles: true, cancelable: true })), 0",
        "document.getElementById('speed').focus(), 0",
        "document.getElementById('speed').dispatchEvent(new PointerEvent('pointerdown', { bubbles: true })), 0",
        "document.getElementById('reset').click(), 0", "document.getElementById('help-open').click(), 0"}) {
    INFO(opens);
    drive();
    desk.browser.evaluate(opens);
    CHECK(desk.state_now() == "held");
    desk.robot_with(stands);
    desk.browser.key("KeyW", false);
    desk.browser.evaluate("document.querySelector('dialog[open]')?.close(), document.activeElement.blur()");
  }
  // a finger that rests on the stick opens no menu
  drive();
  CHECK(desk.browser.evaluate("document.getElementById('stick').dispatchEvent(new MouseEvent('contextmenu', "
                              "{ bubbles: true, cancelable: true }))") == false);
  CHECK(desk.state_now() == "driving");
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: a list gives the keyboard back after a choice by mouse, and Escape is never its own") {
  Desk desk;
  desk.place();
  const auto keeps_focus_after = [&](const std::string& event) {
    return desk.browser.evaluate(
        "(() => { const list = document.getElementById('speed'); list.focus();"
        "  list.dispatchEvent(new " +
        event +
        ");"
        "  list.dispatchEvent(new Event('change')); return document.activeElement === list; })()");
  };
  CHECK(keeps_focus_after("PointerEvent('pointerdown')") == false);
  CHECK(keeps_focus_after("KeyboardEvent('keydown', { key: 'ArrowDown', code: 'ArrowDown' })") == true);
  // closed without a choice it keeps the focus, and letters drive; opened by the keyboard it looks for an entry
  const auto drives_from_list = [&](const std::string& pointer) {
    desk.browser.evaluate("(() => { const list = document.getElementById('speed'); list.blur(); list.focus(); " +
                          pointer + " })()");
    desk.browser.key("KeyW", true);
    const bool drives = desk.state_now() == "driving";
    desk.browser.key("KeyW", false);
    return drives;
  };
  CHECK(drives_from_list("list.dispatchEvent(new PointerEvent('pointerdown'));"));
  CHECK(desk.browser.evaluate("document.activeElement.id") == "stick");
  CHECK_FALSE(drives_from_list(""));
  desk.browser.key("Escape", true);
  desk.browser.key("Escape", false);
  desk.state_is("none");
  desk.robot_with([](const nlohmann::json& robot) { return !robot.contains("holder"); });
}

TEST_CASE(
    "In a browser: stick and sliders say their begin, their end and their newest place, however often they move") {
  Desk desk;
  desk.place();
  watch_words(desk.browser);
  desk.browser.evaluate(
      "window.stick = document.getElementById('stick'), stick.scrollIntoView(),"
      "stick.addEventListener('pointerdown', (event) => { window.pointer = event.pointerId; }), 0");
  const auto box = desk.browser.evaluate(
      "(() => { const box = stick.getBoundingClientRect();"
      "  return { x: box.x, y: box.y, width: box.width, height: box.height }; })()");
  const double middle_x = box["x"].get<double>() + box["width"].get<double>() / 2;
  const double middle_y = box["y"].get<double>() + box["height"].get<double>() / 2;
  desk.browser.mouse("mousePressed", middle_x, middle_y - 0.4 * box["height"].get<double>());
  desk.state_is("driving");
  desk.robot_with(drives);

  // moves within one task, just after a message, so that nothing else is said meanwhile; `up`: by so much of the height
  // above the middle
  const auto words_of_moves = [&](int count, double up, int buttons = 1) {
    return desk.browser.evaluate(
        "(async () => { await news(); const before = sent.length, box = stick.getBoundingClientRect();"
        "  for (let i = 0; i < " +
        std::to_string(count) +
        "; ++i)"
        "    stick.dispatchEvent(new PointerEvent('pointermove', { pointerId: window.pointer, buttons: " +
        std::to_string(buttons) +
        ","
        "      clientX: box.x + box.width / 2, clientY: box.y + box.height * (0.5 - " +
        std::to_string(up) +
        ") }));"
        "  return sent.length - before; })()");
  };
  CHECK(words_of_moves(100, 0.3) == 0);
  CHECK(words_of_moves(10, 0) == 1);
  CHECK(desk.state_now() == "held");
  CHECK(words_of_moves(10, 0.3) == 1);
  CHECK(desk.state_now() == "driving");
  // no button is down: where it was let go of nobody said. It moves again once it is pressed again.
  CHECK(words_of_moves(1, 0.3, 0) == 1);
  CHECK(desk.state_now() == "held");
  CHECK(words_of_moves(10, 0.3) == 0);
  CHECK(desk.state_now() == "held");
  desk.robot_with(stands);
  desk.browser.mouse("mouseReleased", middle_x, middle_y);

  CHECK(desk.browser.evaluate(
            "(async () => { await news(); const before = sent.length, pan = document.getElementById('look-pan');"
            "  for (let i = 1; i <= 30; ++i) { pan.value = i; pan.dispatchEvent(new Event('input')); }"
            "  window.right_rad = pan.value * Math.PI / 180;"
            "  return sent.length - before; })()") == 0);
  CHECK(desk.browser.evaluate("right_rad") > 0.5);  // 30 degrees or the slider's next step, which counts from its end
  desk.browser.wait_for("sent.some((word) => word.type === 'look' && Math.abs(word.pan + right_rad) < 1e-9)");
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: a server that is not heard is told nothing but to stand, until it is heard again") {
  Desk desk;
  desk.place();
  watch_words(desk.browser);
  desk.browser.key("KeyW", true);
  desk.state_is("driving");
  desk.robot_with(drives);
  desk.browser.evaluate("window.take = socket.onmessage, socket.onmessage = () => {}, 0");
  desk.state_is("lost");  // though the key is down
  desk.browser.evaluate("window.before = sent.length, 0");
  wait_300_ms(desk.browser);
  const std::string drives_since = "sent.slice(before).filter((word) => word.type === 'drive')";
  CHECK(desk.browser.evaluate(drives_since + ".length") == 0);
  desk.robot_with(stands);
  desk.browser.evaluate("socket.onmessage = take, 0");
  desk.browser.wait_for(drives_since + ".length > 2");
  CHECK(desk.browser.evaluate(drives_since + ".every((word) => word.left === 0 && word.right === 0)") == true);
  CHECK(desk.browser.complaints().empty());
}

TEST_CASE("In a browser: a robot that was let go of is told nothing more, though states still show it held") {
  Desk desk;
  desk.place();
  watch_words(desk.browser);
  desk.browser.evaluate(
      "window.take = socket.onmessage,"
      "socket.onmessage = (event) => { if (JSON.parse(event.data).type !== 'state') take(event); }, 0");
  desk.browser.key("Escape", true);
  desk.browser.key("Escape", false);
  CHECK(desk.state_now() == "none");
  wait_300_ms(desk.browser);
  CHECK(desk.browser.evaluate("sent.filter((word) => word.type !== 'ping').at(-1).type") == "let-go");
  desk.browser.evaluate("socket.onmessage = take, 0");
  desk.robot_with([](const nlohmann::json& robot) { return !robot.contains("holder"); });
  desk.browser.wait_for("!document.getElementById('take').disabled");
  desk.browser.key("KeyT", true);
  desk.browser.key("KeyT", false);
  desk.state_is("held");
}

}  // namespace kenaf::live
