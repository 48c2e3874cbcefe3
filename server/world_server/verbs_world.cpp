// CONTROL's requests about objects, modelled on the UDK server's WorldController. Objects are boxes; other objects and
// animations of USARSim are refused with a reason.
#include <algorithm>

#include "server/world_server/verbs.hpp"
#include "server/world_server/wire_frames.hpp"

namespace kenaf::world_server {

namespace {

constexpr std::size_t kMostObjects = 1000;
constexpr std::size_t kMostOverlapping = 32;  // objects that another one overlaps where it is placed
constexpr double kLargestMovable_m = 20;      // it meets every triangle of the ground within its extent, in each step
constexpr double kDensity_kgpm3 = 100;        // of movable boxes: light enough for a robot to push

// A name that a request asks for, changed as it was when it was given.
std::string name_in(const MessageView& message) {
  return printable(text_of(message, "Name"));
}

auto find_object(Simulation& simulation, std::string_view name) {
  return std::ranges::find_if(simulation.objects, [name](const WorldObject& object) {
    return protocol::usarsim::equal_ignoring_case(object.name, name);
  });
}

// "USARPhysObj.SmallBox", "Block", "crate": a class whose own name ends in one of these words.
bool is_box_class(std::string_view class_name) {
  class_name.remove_prefix(class_name.rfind('.') + 1);  // npos + 1 is 0
  for (const std::string_view word : {"box", "block", "cube", "crate"}) {
    if (class_name.size() >= word.size() &&
        protocol::usarsim::equal_ignoring_case(class_name.substr(class_name.size() - word.size()), word)) {
      return true;
    }
  }
  return false;
}

// Bodies that overlap cost time in every step: so many that a step stays short.
Reason why_crowded(const physics::World& world, const Eigen::Vector3d& size_m, const physics::Pose& X_WBox,
                   std::optional<physics::BoxId> moved = std::nullopt) {
  if (world.overlapping_boxes(size_m, X_WBox, moved) > kMostOverlapping) {
    return "more than 32 objects are, or began, at that place";
  }
  if (world.pair_count() >= physics::kMostPairs) return "too many objects are close together in this world";
  return kDone;
}

Reason create(Simulation& simulation, const MessageView& message) {
  // Check everything first: a request that is refused leaves no half-made object.
  const std::string_view class_name = text_of(message, "ClassName");
  if (!is_box_class(class_name))
    return "only boxes can be created (a class name that ends in Box, Block, Cube or Crate)";
  if (simulation.objects.size() >= kMostObjects) return "too many objects";
  const std::string name = name_in(message);
  if (name.empty()) return "Name is missing";
  if (find_object(simulation, name) != simulation.objects.end()) return "an object of that name exists already";
  const auto location = read_location(message, "Location");
  if (!location) return "Location is not x,y,z";
  const auto rotation = read_rotation(message, "Rotation");
  if (!rotation && message.find("Rotation")) return "Rotation is not roll,pitch,yaw";
  protocol::frames::Vector3 size_m{1, 1, 1};
  if (message.find("Scale") && !protocol::usarsim::parse_numbers(text_of(message, "Scale"), size_m))
    return "Scale is not x,y,z";
  if (std::ranges::any_of(size_m, [](double size) { return !(size >= 0.001 && size <= 1000); })) {
    return "Scale is not from 0.001 to 1000";
  }

  // Fixed unless the request asks for physics; then its mass follows from its volume.
  physics::Box box;
  box.name = name;
  box.size_m = vector_from(size_m);
  box.X_WBox.p = *location;
  box.X_WBox.q = rotation.value_or(Eigen::Quaterniond::Identity());
  if (is_any_of(text_of(message, "Physics"), {"RigidBody", "Falling", "Ground"})) {
    if (box.size_m.maxCoeff() > kLargestMovable_m) return "Scale is more than 20, for an object that may move";
    box.mass_kg = kDensity_kgpm3 * box.size_m.prod();
  }
  if (const Reason crowded = why_crowded(simulation.world, box.size_m, box.X_WBox); !crowded.empty()) return crowded;

  // All that can fail comes before the box is in the world.
  WorldObject object{{}, name, printable(class_name), box.size_m, bool_of(message, "Permanent").value_or(false)};
  simulation.objects.reserve(simulation.objects.size() + 1);
  object.box = simulation.world.add_box(box);
  simulation.objects.push_back(std::move(object));
  return kDone;
}

Reason kill(Simulation& simulation, const MessageView& message) {
  const auto object = find_object(simulation, name_in(message));
  if (object == simulation.objects.end()) return "no object of that name (a robot leaves with its connection)";
  simulation.world.remove_box(object->box);
  simulation.objects.erase(object);
  return kDone;
}

// Applies to all objects if there is no range, or if both ends are equal.
Reason kill_all(Simulation& simulation, const MessageView& message) {
  protocol::frames::Vector3 least{}, most{};
  for (const auto& [key, corner] : {std::pair{"MinPos", &least}, std::pair{"MaxPos", &most}}) {
    if (message.find(key) && !protocol::usarsim::parse_numbers(text_of(message, key), *corner))
      return "MinPos or MaxPos is not x,y,z";
  }
  std::erase_if(simulation.objects, [&](const WorldObject& object) {
    const protocol::frames::Vector3 location = wire_vector(simulation.world.box_pose(object.box).p);
    bool inside = true;
    for (std::size_t i = 0; i < location.size(); ++i) inside &= location[i] > least[i] && location[i] < most[i];
    if (object.permanent || (least != most && !inside)) return false;
    simulation.world.remove_box(object.box);
    return true;
  });
  return kDone;
}

// Relative moves add up, and what falls off the ground keeps falling: the world rejects poses this far away.
bool is_too_far(const physics::Pose& X_W) {
  return !X_W.q.coeffs().allFinite() || !(X_W.p.cwiseAbs().maxCoeff() <= kFarthest);
}

// Moves an object, or a robot by its name. Components that are not given are kept.
Reason move(Simulation& simulation, const MessageView& message, bool relative) {
  // Each key may be missing, but not malformed.
  const auto location = read_location(message, "Location");
  const auto rotation = read_rotation(message, "Rotation");
  if (!location && message.find("Location")) return "Location is not x,y,z";
  if (!rotation && message.find("Rotation")) return "Rotation is not roll,pitch,yaw";

  // Relative: the location is added in the world's axes, the rotation is about the object's own.
  const auto moved = [&](physics::Pose X_W) {
    if (location) X_W.p = relative ? Eigen::Vector3d(X_W.p + *location) : *location;
    if (rotation) X_W.q = relative ? (X_W.q * *rotation).normalized() : *rotation;
    return X_W;
  };

  // Objects come first; a robot is moved only if no object has its name.
  const std::string name = name_in(message);
  if (const auto object = find_object(simulation, name); object != simulation.objects.end()) {
    const physics::Pose X_WBox = moved(simulation.world.box_pose(object->box));
    if (is_too_far(X_WBox)) return "that is farther away than 100 km";
    if (const Reason crowded = why_crowded(simulation.world, object->size_m, X_WBox, object->box); !crowded.empty()) {
      return crowded;
    }
    simulation.world.move_box(object->box, X_WBox);
    return kDone;
  }
  for (const auto& other : simulation.sessions) {
    if (!other->robot || !protocol::usarsim::equal_ignoring_case(other->robot->name, name)) continue;
    const physics::Pose X_WB = moved(simulation.world.truth(other->robot->id).X_WB);
    if (is_too_far(X_WB)) return "that is farther away than 100 km";
    simulation.world.teleport(other->robot->id, X_WB);
    return kDone;
  }
  return "no object or robot of that name";
}

// One line with all matching objects, as the UDK server wrote it, and the robot of that name.
void get_status(const Simulation& simulation, Session& session, const MessageView& message) {
  // A key that is missing or empty matches all.
  const auto matches = [&](std::string_view key, std::string_view text) {
    const std::string wanted = printable(text_of(message, key));
    return wanted.empty() || protocol::usarsim::equal_ignoring_case(wanted, text);
  };
  protocol::usarsim::MessageWriter writer(session.out);
  writer.begin("STA");
  // Objects first, one group of keys for each.
  for (const WorldObject& object : simulation.objects) {
    if (!matches("Name", object.name) || !matches("ClassName", object.class_name)) continue;
    const physics::Pose X_WBox = simulation.world.box_pose(object.box);
    const protocol::usarsim::NumberFormat format = session.formats.value;
    writer.text("Name", object.name)
        .numbers("Size", array_from(object.size_m), format)
        .numbers("Location", wire_vector(X_WBox.p), format)
        .numbers("Rotation", wire_angles(X_WBox.q), format);
  }

  // Then the robot of that name; without a name no robot is listed.
  const std::string name = name_in(message);
  for (const auto& other : simulation.sessions) {
    if (!other->robot || !protocol::usarsim::equal_ignoring_case(other->robot->name, name)) continue;
    const physics::Pose X_WB = simulation.world.truth(other->robot->id).X_WB;
    writer.text("Name", other->robot->name)
        .numbers("Location", wire_vector(X_WB.p), session.formats.value)
        .numbers("Rotation", wire_angles(X_WB.q), session.formats.value);
  }
  writer.end();
}

}  // namespace

bool control_world(Simulation& simulation, Session& session, const MessageView& message, std::string_view type) {
  Reason reason;
  if (is_any_of(type, {"Create"})) {
    reason = create(simulation, message);
  } else if (is_any_of(type, {"Kill"})) {
    reason = kill(simulation, message);
  } else if (is_any_of(type, {"KillAll"})) {
    reason = kill_all(simulation, message);
  } else if (is_any_of(type, {"AbsMove", "RelMove"})) {
    reason = move(simulation, message, is_any_of(type, {"RelMove"}));
  } else if (is_any_of(type, {"GetSTA"})) {
    get_status(simulation, session, message);
    return true;
  } else if (is_any_of(type, {"Rotate", "AddWP", "SetWP", "ClearWP", "Conveyor"})) {
    reason = "objects that move by themselves are not supported";
  } else {
    return false;
  }
  answer(simulation, session, "Control", type, reason);
  return true;
}

}  // namespace kenaf::world_server
