// A person at the page of a served world, in a real browser. What the robot does is asked of the world server by a
// second page, not of the browser that drives.
#pragma once

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/server/live/browser.hpp"
#include "tests/server/live/served_world.hpp"
#include "tests/server/live/web_client.hpp"
#include "tests/support/process.hpp"
#include "tests/support/tcp_proxy.hpp"

namespace kenaf::live {

struct Desk {
  support::TemporaryFolder profile;
  ServedWorld world{"", patient_limits(), "step-200"};
  Browser browser;
  support::TcpProxy link;
  std::filesystem::path pictures = std::filesystem::path(KENAF_BIN_DIR) / ".." / "live-view";

  // `switches`: further ones of the browser's. `each_way`: how long all bytes between browser and server are under way.
  explicit Desk(const std::vector<std::string>& switches = {}, std::chrono::milliseconds each_way = {})
      : browser(profile.path(), switches), link(world.port(), each_way) {
    std::filesystem::create_directories(pictures);
    browser.resize(1280, 800);
    browser.open(each_way.count() == 0 ? world.url() : "http://127.0.0.1:" + std::to_string(link.port()) + "/");
    browser.wait_for("document.getElementById('link')?.dataset.state === 'good'");
  }
  // The state of the first robot, once `condition` holds of it.
  template <typename Condition>
  nlohmann::json robot_with(Condition condition) {
    WebClient witness(world.port());  // its own each time: one that is not read for 10 s is let go of
    REQUIRE(witness.open_websocket());
    for (;;) {
      const nlohmann::json state = witness.message_of("state");
      if (!state["robots"].empty() && condition(state["robots"][0])) return state["robots"][0];
    }
  }
  void state_is(const std::string& state) {
    browser.wait_for("document.getElementById('drive-state').dataset.state === '" + state + "'");
  }
  std::string state_now() { return browser.evaluate("document.getElementById('drive-state').dataset.state"); }
  void press(std::string_view code) {
    browser.key(code, true);
    browser.key(code, false);
  }
  // At a free start: Enter, where a place could be pointed at; nothing is left to press where there is no 3D view.
  void place() {
    browser.evaluate("document.getElementById('place').click()");
    press("Enter");
    state_is("held");
  }
};

inline bool drives(const nlohmann::json& robot) {
  return robot["track_mps"][0] > 0.1;
}
inline bool stands(const nlohmann::json& robot) {
  return robot["command"]["track"] == nlohmann::json::array({0, 0}) &&
         std::abs(robot["track_mps"][0].get<double>()) < 0.01;
}

}  // namespace kenaf::live
