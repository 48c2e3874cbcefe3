// Brings the contacts of belts (belt_contacts.hpp) into Bullet: one algorithm for each pair of a belt and a plane, box
// or mesh, and the list of these pairs for the contact solver.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "physics/dynamics/belt_contacts.hpp"
#include "physics/dynamics/bullet.hpp"
#include "physics/dynamics/hull_plane.hpp"
#include "physics/dynamics/hull_solid.hpp"

namespace kenaf::physics {

// Stored at btCollisionShape::getUserPointer() of the shapes that belts can meet.
struct ShapeTag {
  const BeltShape* belt = nullptr;      // this convex hull is a belt
  const btVector3* box_half = nullptr;  // this convex hull is a box, origin at its centre
  const class MeshEdges* mesh = nullptr;
};

// A mesh's triangles with their neighbours across each edge.
class MeshEdges {
 public:
  MeshEdges(const std::vector<btVector3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles);
  TriangleInT triangle(std::size_t index) const { return triangles_[index]; }  // in the mesh's own frame

 private:
  std::vector<TriangleInT> triangles_;
};

// A contact with the impulses that the solver keeps from step to step.
struct BeltContact {
  BeltTouch touch;
  std::array<btScalar, 3> impulse;  // normal, along, across
};

// All contacts between one belt and one other object.
struct BeltPair {
  const btCollisionObject *body, *ground;
  const BeltShape* belt;
  btTransform X_WT;  // at this step
  std::vector<BeltContact> contacts;
};

class BeltGround {
 public:
  // Makes `dispatcher` use it for belts. Other hulls meet planes by `hull_plane`, boxes and hulls by `hull_solid`,
  // meshes as `configuration` has it.
  BeltGround(btCollisionDispatcher& dispatcher, btCollisionConfiguration& configuration, HullPlaneContacts& hull_plane,
             HullSolidContacts& hull_solid);
  ~BeltGround();
  BeltGround(const BeltGround&) = delete;
  BeltGround& operator=(const BeltGround&) = delete;

  // While probing, belts meet the ground as any hull does, which also finds deep penetrations, for placing a robot.
  void set_probing(bool probing) { probing_ = probing; }
  // Reserves memory for so many pairs in all, so that a step need not allocate.
  void make_room(std::size_t pairs);
  const std::vector<BeltPair*>& pairs() const { return pairs_; }

 private:
  class Algorithm;
  struct Create;
  struct Pair;
  void add_spare();

  std::vector<std::unique_ptr<Create>> create_;
  std::vector<BeltPair*> pairs_;
  std::vector<std::unique_ptr<Pair>> spare_;
  bool probing_ = false;
  std::vector<BeltTouch> touches_;  // scratch
};

}  // namespace kenaf::physics
