#include "physics/files/sdf_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <optional>

#include "formats/description/description_error.hpp"
#include "physics/files/sdf_frames.hpp"
#include "physics/files/sdf_values.hpp"
#include "physics/height_map.hpp"
#include "physics/mesh_file.hpp"
#include "physics/surface_shapes.hpp"

namespace kenaf::physics {
namespace {

constexpr double kMaxSize_m = SdfFrames::kMaxCoordinate_m;

void check_sizes(const SdfElement& shape, std::initializer_list<double> sizes) {
  for (const double size : sizes)
    if (!(size > 0 && size <= kMaxSize_m))
      fail_at(shape, fmt::format("the sizes of a <{}> must be more than 0 and at most {} m", shape.name, kMaxSize_m));
}

// Errors of files and surfaces get the place of the shape.
template <typename Read>
auto at_place_of(const SdfElement& shape, const Read& read) {
  try {
    return read();
  } catch (const description::DescriptionError& error) {
    fail_at(shape, error.what());
  }
}

// Calls read(bytes) for a file that is found as `uri`; its errors get that name.
template <typename Read>
auto read_named_file(ShapeFiles& files, const std::filesystem::path& file, const std::string& uri, const Read& read) {
  const std::string bytes = files.files.read(file);
  try {
    return read(bytes);
  } catch (const description::DescriptionError& error) {
    throw description::DescriptionError(fmt::format("\"{}\" {}", uri, error.what()));
  }
}

TriangleSurface read_polyline(const SdfElement& polyline) {
  const double height_m = number_in(polyline, "height", 1);
  check_sizes(polyline, {height_m});
  std::vector<Eigen::Vector2d> corners;
  for (const SdfElement& point : polyline.children) {
    if (point.name != "point") continue;
    corners.push_back(vector2_of(point));
    if (!corners.back().allFinite() || corners.back().norm() > kMaxSize_m)
      fail_at(point, fmt::format("a <point> is not a number or further than {} m away", kMaxSize_m));
  }
  return at_place_of(polyline, [&] { return prism_surface(std::move(corners), height_m); });
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

std::string uri_of(const SdfElement& shape) {
  const std::string uri = text_in(shape, "uri");
  if (uri.empty()) fail_at(shape, fmt::format("a <{}> needs a <uri>", shape.name));
  return uri;
}

const MeshContent& content_of(const SdfElement& mesh, const std::string& uri, MeshFormat format, ShapeFiles& files,
                              std::size_t most_triangles) {
  const SdfElement* submesh = child_of(mesh, "submesh");
  const MeshPart part{submesh ? text_in(*submesh, "name") : "", submesh && truth_in(*submesh, "center", false)};
  return *at_place_of(mesh, [&] {
    const std::filesystem::path file = files.files.find(uri, *mesh.file);
    const std::tuple key(file, part.submesh, part.centred);
    if (const auto known = files.meshes.find(key); known != files.meshes.end()) return &known->second;
    const auto read = [&](const std::string& bytes) { return read_mesh(bytes, format, part, most_triangles); };
    return &files.meshes.emplace(key, read_named_file(files, file, uri, read)).first->second;
  });
}

TriangleSurface read_mesh_element(SdfNotes& notes, const SdfElement& mesh, ShapeFiles& files,
                                  std::size_t most_triangles) {
  const std::string uri = uri_of(mesh);
  const std::optional<MeshFormat> format = format_of(uri);
  if (!format) fail_at(mesh, fmt::format("\"{}\": a mesh must be a .stl, .obj or .dae file", uri));
  const Eigen::Vector3d scale = vector3_in(mesh, "scale", {1, 1, 1});
  if (!scale.allFinite() || !(scale.cwiseAbs().minCoeff() > 0)) fail_at(mesh, "<scale> must not be zero");
  const MeshContent& content = content_of(mesh, uri, *format, files, most_triangles);
  if (content.other_faces > 0)
    notes.add(place_of(mesh), fmt::format("\"{}\": {} points and lines are not simulated", uri, content.other_faces));

  // A scale that mirrors turns the triangles inside out.
  TriangleSurface surface = content.surface;
  for (Eigen::Vector3d& p : surface.vertices) p = p.cwiseProduct(scale);
  if (scale.prod() < 0)
    for (auto& t : surface.triangles) std::swap(t[1], t[2]);
  return surface;
}

TriangleSurface read_height_map_element(const SdfElement& map, ShapeFiles& files) {
  const Eigen::Vector3d size = vector3_in(map, "size", {1, 1, 1}), position = vector3_in(map, "pos", {0, 0, 0});
  check_sizes(map, {size.x(), size.y(), size.z()});
  if (!position.allFinite()) fail_at(map, "<pos> must be numbers");
  const std::string uri = uri_of(map);
  return at_place_of(map, [&] {
    const std::filesystem::path file = files.files.find(uri, *map.file);
    auto known = files.pictures.find(file);
    if (known == files.pictures.end())
      known = files.pictures.emplace(file, read_named_file(files, file, uri, read_grey_png)).first;
    return height_map_surface(known->second, size, position);
  });
}

TriangleSurface read_ellipsoid(const SdfElement& ellipsoid) {
  const Eigen::Vector3d radii = vector3_in(ellipsoid, "radii", {1, 1, 1});
  check_sizes(ellipsoid, {radii.x(), radii.y(), radii.z()});
  return ellipsoid_surface(radii);
}

// A shape of one radius, and of a length if it has one. Returns make(radius, length).
template <typename Make>
TriangleSurface read_round(const SdfElement& shape, double default_radius_m, const Make& make) {
  const double radius_m = number_in(shape, "radius", default_radius_m), length_m = number_in(shape, "length", 1);
  check_sizes(shape, {radius_m, length_m});
  return make(radius_m, length_m);
}

TriangleSurface read_shape(SdfNotes& notes, const SdfElement& shape, ShapeFiles& files, std::size_t most_triangles) {
  if (shape.name == "cylinder") return read_round(shape, 1, cylinder_surface);
  if (shape.name == "capsule") return read_round(shape, 0.5, capsule_surface);
  if (shape.name == "sphere")
    return read_round(shape, 1, [](double radius_m, double) { return sphere_surface(radius_m); });
  if (shape.name == "ellipsoid") return read_ellipsoid(shape);
  if (shape.name == "mesh") return read_mesh_element(notes, shape, files, most_triangles);
  if (shape.name == "heightmap") return read_height_map_element(shape, files);
  return read_polyline(shape);
}

}  // namespace

TriangleSurface read_surface(SdfNotes& notes, const SdfElement& shape, ShapeFiles& files, std::size_t most_triangles) {
  TriangleSurface surface = read_shape(notes, shape, files, most_triangles);

  // Limits, then tidying; what is left out or doubtful is noted.
  if (surface.triangles.size() > most_triangles)
    fail_at(shape, fmt::format("the world has too many triangles: only {} are left for this <{}>", most_triangles,
                               shape.name));
  for (const Eigen::Vector3d& p : surface.vertices)
    if (!(p.norm() <= kMaxSize_m)) fail_at(shape, fmt::format("a vertex is further than {} m away", kMaxSize_m));
  const TidySurface tidied = tidy(surface);
  if (tidied.dropped > 0)
    notes.add(place_of(shape), fmt::format("{} triangles without area are left out", tidied.dropped));
  if (!tidied.windings_agree)
    notes.add(place_of(shape),
              "neighbouring triangles do not agree on which side of them is out; robots may fall through");
  if (surface.triangles.empty()) fail_at(shape, "no triangle has an area");
  return surface;
}

}  // namespace kenaf::physics
