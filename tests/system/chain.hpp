// World server, relay and user programs as the processes they are, for tests of the whole chain.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "formats/runs/run_file.hpp"
#include "tests/support/process.hpp"

namespace kenaf::system_test {

using Environment = std::map<std::string, std::string>;

class Chain {
 public:
  // Starts both servers on ephemeral ports of `host`, a loopback address; `speed` is kenaf-world's, `robot_class` the
  // relay's.
  explicit Chain(const std::string& speed, const std::string& world = "flat", bool has_cameras = false,
                 const std::string& robot_class = "USARBot.Kenaf", const std::string& host = "127.0.0.1");

  // A user program that drives through this chain; `name` is a program of the build's bin folder.
  support::Process start_program(const std::string& name, Environment environment = {}) const;

  void start_world();  // again on the same port after it ended
  support::Process& world() { return *world_; }
  support::Process& relay() { return *relay_; }
  std::uint16_t world_port() const { return world_port_; }
  std::uint16_t relay_port() const { return relay_port_; }
  std::uint16_t camera_port() const;  // of a chain that has cameras
  const std::filesystem::path& folder() const { return folder_.path(); }

  // All that a program (or "world", "relay") printed so far.
  std::string log(const std::string& name) const;

 private:
  support::TemporaryFolder folder_;
  std::string speed_, world_name_, host_;
  bool has_cameras_;
  std::unique_ptr<support::Process> world_, relay_;
  std::uint16_t world_port_ = 0, relay_port_ = 0;
};

struct Pose2 {
  double x_m, y_m, yaw_rad;
};
// Every ground truth pose of a recorded run, in order.
std::vector<Pose2> path_of(const runs::Run& run);

}  // namespace kenaf::system_test
