// One engine that simulates one scene, and the engines there are.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/engines/engine_scene.hpp"

namespace kenaf::bench {

class Runner {
 public:
  virtual ~Runner() = default;
  virtual void step() = 0;
  virtual std::size_t contacts() const = 0;  // of the last step
  virtual physics::Pose pose() const = 0;    // of the robot's body frame or the block's centre, in W
};

struct Engine {
  std::string name;     // "MuJoCo"
  std::string version;
  std::string setting;  // "Newton, elliptic"
  bool same_contacts;   // about as many as Kenaf, along all of a track; else fewer, for the record: no limit
  std::function<std::unique_ptr<Runner>(const EngineScene&)> build;
};

std::vector<Engine> kenaf_engines();   // without sensors, with
std::vector<Engine> mujoco_engines();
std::vector<Engine> ode_engines();

}  // namespace kenaf::bench
