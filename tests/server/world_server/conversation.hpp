// A client and a simulation without sockets: what the client sends is handled at once, time passes when the test says.
#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "robot/angles.hpp"
#include "server/world_server/simulation.hpp"
#include "tests/support/usarsim_client.hpp"

namespace kenaf::world_server {

using support::number_in;

inline ServerOptions fast(bool udk_dialect = false) {
  ServerOptions options;
  options.speed = 0;
  options.udk_dialect = udk_dialect;
  return options;
}

struct Conversation {
  Simulation simulation;
  double wall_s = 100;
  Session* session;

  explicit Conversation(const ServerOptions& options = fast())
      : simulation(options), session(&simulation.connect("test")) {}

  void send(std::string_view text) { send(*session, text); }
  void send(Session& from, std::string_view text) {
    for (bool more = simulation.receive(from, text, wall_s); more;) more = simulation.receive(from, {}, wall_s);
  }

  // Lets robot time pass; false: it stood still before the end.
  bool run(double robot_time_s) {
    const std::uint64_t end = simulation.world.step_count() + simulation.steps_for(robot_time_s);
    while (simulation.world.step_count() < end) {
      if (!simulation.advance(wall_s).stepped) return false;
    }
    return true;
  }

  // Takes what the client was sent so far.
  std::vector<std::string> lines() { return lines(*session); }
  static std::vector<std::string> lines(Session& of) {
    std::vector<std::string> all;
    std::string_view rest = of.out;
    while (!rest.empty()) {
      const std::size_t end = rest.find("\r\n");
      REQUIRE(end != std::string_view::npos);
      all.emplace_back(rest.substr(0, end));
      rest.remove_prefix(end + 2);
    }
    of.out.clear();
    return all;
  }
  // Of these, the ones that begin so.
  std::vector<std::string> lines(std::string_view start) {
    std::vector<std::string> all = lines();
    std::erase_if(all, [start](const std::string& line) { return !line.starts_with(start); });
    return all;
  }
  // The last of them, "" where there is none.
  std::string last(std::string_view start) {
    const std::vector<std::string> all = lines(start);
    return all.empty() ? std::string() : all.back();
  }
  // What is answered to `text`, before time passes.
  std::string answer_to(std::string_view text) {
    lines();
    send(text);
    std::string all = session->out;
    session->out.clear();
    if (all.ends_with("\r\n")) all.resize(all.size() - 2);
    return all;
  }

  physics::RobotTruth truth() { return simulation.world.truth(session->robot->id); }
  robot::Command command() { return session->robot->command; }
};

// An angle as the UT2004 server writes it, from 0 to 2 pi, back to signed.
inline double angle_in(std::string_view line, std::string_view key, std::size_t index) {
  return robot::wrap_angle(number_in(line, key, index));
}

}  // namespace kenaf::world_server
