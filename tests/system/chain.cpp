#include "tests/system/chain.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace kenaf::system_test {

using support::Process;

Chain::Chain(const std::string& speed, const std::string& world, bool has_cameras, const std::string& robot_class,
             const std::string& host)
    : speed_(speed), world_name_(world), host_(host), has_cameras_(has_cameras) {
  start_world();
  const std::filesystem::path port_file = folder() / "relay.port";
  relay_ = std::make_unique<Process>(
      std::vector<std::string>{KENAF_BIN_DIR "/kenaf-relayd", "--world-server",
                               host_ + ":" + std::to_string(world_port_), "--listen", host_ + ":0", "--port-file",
                               port_file.string(), "--class", robot_class},
      folder() / "relay.log");
  relay_port_ = support::wait_for_port(port_file, *relay_);
}

void Chain::start_world() {
  const std::filesystem::path port_file = folder() / "world.port";
  std::filesystem::remove(port_file);
  world_.reset();
  world_ = std::make_unique<Process>(
      std::vector<std::string>{KENAF_BIN_DIR "/kenaf-world", "--view", "off", "--cameras", has_cameras_ ? "on" : "off",
                               "--camera-port", "0", "--world", world_name_, "--speed", speed_, "--port",
                               std::to_string(world_port_), "--listen", host_, "--port-file", port_file.string()},
      folder() / "world.log");
  world_port_ = support::wait_for_port(port_file, *world_);
}

Process Chain::start_program(const std::string& name, Environment environment) const {
  environment.try_emplace("KENAF_RELAY", host_ + ":" + std::to_string(relay_port_));
  environment.try_emplace("KENAF_CONFIG", "");  // no configuration of the machine's user
  return Process({KENAF_BIN_DIR "/" + name}, folder() / (name + ".log"), environment);
}

std::uint16_t Chain::camera_port() const {
  // It listens before the world's port is written.
  const std::string words = "camera pictures on 127.0.0.1:", text = log("world");
  const std::size_t at = text.find(words);
  if (at == std::string::npos) throw std::runtime_error("kenaf-world serves no pictures: " + text);
  return static_cast<std::uint16_t>(std::stoi(text.substr(at + words.size())));
}

std::string Chain::log(const std::string& name) const {
  std::ifstream file(folder() / (name + ".log"));
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<Pose2> path_of(const runs::Run& run) {
  const auto x = run.column("x_m"), y = run.column("y_m"), yaw = run.column("yaw_rad");
  std::vector<Pose2> path;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isnan(x[i])) path.push_back({x[i], y[i], yaw[i]});
  }
  return path;
}

}  // namespace kenaf::system_test
