// How far collision shapes reach: primitives exactly, meshes by their corners.
//
// Thread safety: a Meshes belongs to one thread.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/describe/urdf_model.hpp"

namespace kenaf::describe {

// Where the files are that a URDF names.
struct MeshFolders {
  std::optional<std::filesystem::path> beside;  // the URDF's folder, for relative names; none: no file is opened
  std::map<std::string, std::filesystem::path> packages;  // package://NAME/...
};

// Reads each mesh once. One that cannot be read has no corners, and is among the complaints, with the reason.
class Meshes {
 public:
  explicit Meshes(MeshFolders folders) : folders_(std::move(folders)) {}
  const std::vector<Eigen::Vector3d>& corners(const std::string& uri);  // in the file's frame, without scale
  const std::map<std::string, std::string>& complaints() const { return complaints_; }  // by URI

 private:
  std::filesystem::path path_of(const std::string& uri) const;

  MeshFolders folders_;
  std::map<std::string, std::vector<Eigen::Vector3d>> corners_;
  std::map<std::string, std::string> complaints_;
};

// Returns the box around a shape along A's axes; empty for a mesh that was not read.
Eigen::AlignedBox3d bounds_of(const Shape& shape, const physics::Pose& X_AS, Meshes& meshes);
// The same around all shapes of some links, in F.
Eigen::AlignedBox3d bounds_of(const UrdfModel& model, const std::vector<std::size_t>& links, Meshes& meshes);

}  // namespace kenaf::describe
