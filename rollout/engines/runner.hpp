// Other physics engines that simulate one scene, as far as this was built with them. For comparison in a benchmark, and
// for a "reality" whose contacts are not those of the model.
//
// Thread safety: none for one Runner; any number of them may be built and stepped at once.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rollout/engines/engine_scene.hpp"

namespace kenaf::engines {

class Runner {
 public:
  virtual ~Runner() = default;
  virtual void step() = 0;
  virtual std::size_t contacts() const = 0;  // of the last step
  virtual physics::Pose pose() const = 0;    // of the robot's body frame or the block's centre, in W
};

struct Engine {
  std::string name;  // "MuJoCo"
  std::string version;
  std::string setting;  // "Newton, elliptic"
  bool same_contacts;   // about as many as Kenaf, along all of a track; otherwise fewer, and no limit applies
  std::function<std::unique_ptr<Runner>(const EngineScene&)> build;
};

std::vector<Engine> mujoco_engines();
std::vector<Engine> ode_engines();
// QuickStep orders constraints at random, by a generator that all worlds of a process share. This engine reseeds it in
// each step, one world at a time, so that a run has the same bits whatever else runs.
Engine repeatable_ode_engine();

}  // namespace kenaf::engines
