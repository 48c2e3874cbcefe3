#include "physics/files/sdf_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <optional>
#include <sdf/Capsule.hh>
#include <sdf/Cylinder.hh>
#include <sdf/Ellipsoid.hh>
#include <sdf/Heightmap.hh>
#include <sdf/Mesh.hh>
#include <sdf/Sphere.hh>

#include "formats/description/description_error.hpp"
#include "physics/height_map.hpp"
#include "physics/mesh_file.hpp"
#include "physics/surface_shapes.hpp"

namespace kenaf::physics {
namespace {

Eigen::Vector3d from_sdf(const ignition::math::Vector3d& v) {
  return {v.X(), v.Y(), v.Z()};
}

// Throws DescriptionError unless all sizes are positive and not too large. read_surface() adds the place to errors of
// this and of the functions below.
void check_sizes(const sdf::ElementPtr& element, std::initializer_list<double> sizes) {
  for (const double size : sizes)
    if (!(size > 0 && size <= kMaxCoordinate_m))
      throw description::DescriptionError(fmt::format("the sizes of a <{}> must be more than 0 and at most {} m",
                                                      element->GetName(), kMaxCoordinate_m));
}

TriangleSurface read_polyline(const sdf::ElementPtr& element) {
  std::vector<Eigen::Vector2d> corners;
  for (sdf::ElementPtr point = element->FindElement("point"); point; point = point->GetNextElement("point")) {
    const auto p = point->Get<ignition::math::Vector2d>();
    corners.emplace_back(p.X(), p.Y());
    if (!corners.back().allFinite() || corners.back().norm() > kMaxCoordinate_m)
      throw description::DescriptionError(
          fmt::format("a <point> is not a number or further than {} m away", kMaxCoordinate_m));
  }
  return prism_surface(std::move(corners), element->Get<double>("height"));
}

std::optional<MeshFormat> format_of(const std::string& uri) {
  const std::size_t dot = uri.rfind('.');
  std::string ending = dot == std::string::npos ? "" : uri.substr(dot);
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (ending == ".stl") return MeshFormat::stl;
  if (ending == ".obj") return MeshFormat::obj;
  if (ending == ".dae") return MeshFormat::dae;
  return std::nullopt;
}

// The errors of the file get its name.
template <typename Read>
auto named(const std::string& uri, const Read& read) {
  try {
    return read();
  } catch (const description::DescriptionError& error) {
    throw description::DescriptionError(fmt::format("\"{}\" {}", uri, error.what()));
  }
}

const MeshContent& content_of(const sdf::Mesh& mesh, MeshFormat format, ShapeFiles& files, std::size_t most_triangles) {
  const MeshPart part{mesh.Submesh(), mesh.CenterSubmesh()};
  const std::filesystem::path file = files.files.find(mesh.Uri(), mesh.Element()->FilePath());
  const std::tuple key(file, part.submesh, part.centred);
  const auto known = files.meshes.find(key);
  if (known != files.meshes.end()) return known->second;
  const std::string bytes = files.files.read(file);
  return files.meshes[key] = named(mesh.Uri(), [&] { return read_mesh(bytes, format, part, most_triangles); });
}

TriangleSurface read_mesh_element(SdfNotes& notes, const sdf::Mesh& mesh, ShapeFiles& files,
                                  std::size_t most_triangles) {
  const std::optional<MeshFormat> format = format_of(mesh.Uri());
  if (!format)
    throw description::DescriptionError(fmt::format("\"{}\": a mesh must be a .stl, .obj or .dae file", mesh.Uri()));
  const Eigen::Vector3d scale = from_sdf(mesh.Scale());
  if (!scale.allFinite() || !(scale.cwiseAbs().minCoeff() > 0))
    throw description::DescriptionError("<scale> must not be zero");
  const MeshContent& content = content_of(mesh, *format, files, most_triangles);
  if (content.other_faces > 0)
    notes.add(place_of(mesh.Element()),
              fmt::format("\"{}\": {} points and lines are not simulated", mesh.Uri(), content.other_faces));

  // A scale that mirrors turns the triangles inside out.
  TriangleSurface surface = content.surface;
  for (Eigen::Vector3d& p : surface.vertices) p = p.cwiseProduct(scale);
  if (scale.prod() < 0)
    for (auto& t : surface.triangles) std::swap(t[1], t[2]);
  return surface;
}

TriangleSurface read_height_map_element(const sdf::Heightmap& map, ShapeFiles& files) {
  const Eigen::Vector3d size = from_sdf(map.Size()), position = from_sdf(map.Position());
  check_sizes(map.Element(), {size.x(), size.y(), size.z()});
  if (!position.allFinite()) throw description::DescriptionError("<pos> must be numbers");
  const std::filesystem::path file = files.files.find(map.Uri(), map.Element()->FilePath());
  const auto [picture, is_new] = files.pictures.try_emplace(file);
  if (is_new) {
    const std::string bytes = files.files.read(file);
    picture->second = named(map.Uri(), [&] { return read_grey_png(bytes); });
  }
  return height_map_surface(picture->second, size, position);
}

// `element` becomes that of the shape, for errors.
TriangleSurface read_shape(SdfNotes& notes, const sdf::Geometry& geometry, ShapeFiles& files,
                           std::size_t most_triangles, sdf::ElementPtr& element) {
  // One branch for each shape; sizes are checked first.
  if (const sdf::Cylinder* cylinder = geometry.CylinderShape()) {
    element = cylinder->Element();
    check_sizes(element, {cylinder->Radius(), cylinder->Length()});
    return cylinder_surface(cylinder->Radius(), cylinder->Length());
  }
  if (const sdf::Sphere* sphere = geometry.SphereShape()) {
    element = sphere->Element();
    check_sizes(element, {sphere->Radius()});
    return sphere_surface(sphere->Radius());
  }
  if (const sdf::Capsule* capsule = geometry.CapsuleShape()) {
    element = capsule->Element();
    check_sizes(element, {capsule->Radius(), capsule->Length()});
    return capsule_surface(capsule->Radius(), capsule->Length());
  }
  if (const sdf::Ellipsoid* ellipsoid = geometry.EllipsoidShape()) {
    element = ellipsoid->Element();
    const Eigen::Vector3d radii = from_sdf(ellipsoid->Radii());
    check_sizes(element, {radii.x(), radii.y(), radii.z()});
    return ellipsoid_surface(radii);
  }
  if (const sdf::Mesh* mesh = geometry.MeshShape()) {
    element = mesh->Element();
    return read_mesh_element(notes, *mesh, files, most_triangles);
  }
  if (const sdf::Heightmap* map = geometry.HeightmapShape()) {
    element = map->Element();
    return read_height_map_element(*map, files);
  }
  if (geometry.Element()->HasElement("polyline")) {
    element = geometry.Element()->GetElement("polyline");
    check_sizes(element, {element->Get<double>("height")});
    return read_polyline(element);
  }
  return {};
}

}  // namespace

TriangleSurface read_surface(SdfNotes& notes, const sdf::Geometry& geometry, ShapeFiles& files,
                             std::size_t most_triangles) {
  sdf::ElementPtr element = geometry.Element();
  TriangleSurface surface;
  try {
    surface = read_shape(notes, geometry, files, most_triangles, element);
  } catch (const description::DescriptionError& error) {
    fail_at(element, error.what());
  }

  // Limits, then tidying; what is left out or doubtful is noted.
  if (surface.triangles.empty()) return surface;
  if (surface.triangles.size() > most_triangles)
    fail_at(element, fmt::format("the world has too many triangles: only {} are left for this <{}>", most_triangles,
                                 element->GetName()));
  for (const Eigen::Vector3d& p : surface.vertices)
    if (!(p.norm() <= kMaxCoordinate_m))
      fail_at(element, fmt::format("a vertex is further than {} m away", kMaxCoordinate_m));
  const TidySurface tidied = tidy(surface);
  if (tidied.dropped > 0)
    notes.add(place_of(element), fmt::format("{} triangles without area are left out", tidied.dropped));
  if (!tidied.windings_agree)
    notes.add(place_of(element),
              "neighbouring triangles do not agree on which side of them is out; robots may fall through");
  if (surface.triangles.empty()) fail_at(element, "no triangle has an area");
  return surface;
}

}  // namespace kenaf::physics
