#include "tools/describe/shape_bounds.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>

#include "formats/runs/whole_file.hpp"
#include "physics/mesh_file.hpp"

namespace kenaf::describe {
namespace {

namespace fs = std::filesystem;
using physics::Pose;

constexpr std::size_t kMostTriangles = std::size_t{1} << 20;
constexpr std::uintmax_t kMostMeshBytes = std::uintmax_t{64} << 20;

physics::MeshFormat format_of(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".stl") return physics::MeshFormat::stl;
  if (extension == ".obj") return physics::MeshFormat::obj;
  if (extension == ".dae") return physics::MeshFormat::dae;
  throw description::DescriptionError("is neither .stl, .obj nor .dae");
}

std::vector<Eigen::Vector3d> corners_in(const fs::path& file) {
  const physics::MeshFormat format = format_of(file);
  std::error_code error;
  if (!fs::is_regular_file(file, error)) throw description::DescriptionError("is not there");
  if (fs::file_size(file, error) > kMostMeshBytes || error)
    throw description::DescriptionError(fmt::format("is larger than {} MiB", kMostMeshBytes >> 20));
  return physics::read_mesh(runs::read_whole_file(file), format, {}, kMostTriangles).surface.vertices;
}

// Half of what a cylinder reaches along each axis of A: its ends' discs, and its length.
Eigen::Vector3d half_of_cylinder(double radius_m, double length_m, const Eigen::Vector3d& axis_A) {
  const Eigen::Vector3d a = axis_A.cwiseAbs();
  return length_m / 2 * a +
         radius_m * Eigen::Vector3d(std::hypot(a.y(), a.z()), std::hypot(a.x(), a.z()), std::hypot(a.x(), a.y()));
}

}  // namespace

fs::path Meshes::path_of(const std::string& uri) const {
  using description::DescriptionError;
  if (!folders_.beside) throw DescriptionError("is not read here");
  constexpr std::string_view kPackage = "package://", kFile = "file://";
  if (uri.starts_with(kFile)) return uri.substr(kFile.size());
  if (!uri.starts_with(kPackage)) {
    if (uri.find("://") != std::string::npos) throw DescriptionError("is neither a file nor in a package");
    return *folders_.beside / uri;
  }
  const std::string rest = uri.substr(kPackage.size());
  const std::string name = rest.substr(0, rest.find('/'));
  const auto package = folders_.packages.find(name);
  if (package == folders_.packages.end()) throw DescriptionError(fmt::format("needs --package {}=FOLDER", name));
  return package->second / rest.substr(std::min(rest.size(), name.size() + 1));
}

const std::vector<Eigen::Vector3d>& Meshes::corners(const std::string& uri) {
  const auto [found, fresh] = corners_.try_emplace(uri);
  if (!fresh) return found->second;
  try {
    found->second = corners_in(path_of(uri));
  } catch (const std::exception& error) {
    complaints_[uri] = error.what();
  }
  return found->second;
}

Eigen::AlignedBox3d bounds_of(const Shape& shape, const Pose& X_AS, Meshes& meshes) {
  const Eigen::Matrix3d R_AS = X_AS.q.toRotationMatrix();
  if (shape.kind == Shape::Kind::mesh) {
    Eigen::AlignedBox3d bounds;
    for (const Eigen::Vector3d& corner : meshes.corners(shape.mesh))
      bounds.extend(X_AS.p + R_AS * corner.cwiseProduct(shape.size_m));
    return bounds;
  }
  const Eigen::Vector3d half = shape.kind == Shape::Kind::box ? Eigen::Vector3d(R_AS.cwiseAbs() * shape.size_m / 2)
                               : shape.kind == Shape::Kind::sphere
                                   ? Eigen::Vector3d(Eigen::Vector3d::Constant(shape.radius_m))
                                   : half_of_cylinder(shape.radius_m, shape.length_m, R_AS.col(2));
  return {X_AS.p - half, X_AS.p + half};
}

Eigen::AlignedBox3d bounds_of(const UrdfModel& model, const std::vector<std::size_t>& links, Meshes& meshes) {
  Eigen::AlignedBox3d bounds;
  for (const std::size_t i : links)
    for (const Shape& shape : model.links[i].shapes)
      bounds.extend(bounds_of(shape, compose(model.links[i].X_FL, shape.X_LS), meshes));
  return bounds;
}

}  // namespace kenaf::describe
