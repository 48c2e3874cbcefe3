// Another physics engine that simulates one scene, and the engines there are: those that this was built with. For a
// benchmark to be compared with, and for a "reality" whose contacts are not those of the model.
//
// Thread safety: none of a Runner; each has its own, and any number may be built and stepped at once.
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
  bool same_contacts;   // about as many as Kenaf, along all of a track; else fewer, for the record: no limit
  std::function<std::unique_ptr<Runner>(const EngineScene&)> build;
};

std::vector<Engine> mujoco_engines();
std::vector<Engine> ode_engines();
// QuickStep takes constraints in an order by chance, from a generator that all worlds of a process share: this one
// begins it anew in each step, one world at a time, so that a run has the same bits whatever else runs.
Engine repeatable_ode_engine();

}  // namespace kenaf::engines
