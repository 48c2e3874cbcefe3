#include "physics/mesh_file.hpp"

#include <assimp/BaseImporter.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <expat.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <charconv>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "physics/robot_description.hpp"
#include "physics/xml_line.hpp"

namespace kenaf::physics {
namespace {

std::string extension_of(MeshFormat format) {
  return format == MeshFormat::stl ? "stl" : format == MeshFormat::obj ? "obj" : "dae";
}

// The only file that assimp can open: the given bytes, under one name.
class OneFile final : public Assimp::IOSystem {
 public:
  OneFile(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}
  bool Exists(const char* name) const override { return name == name_; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (!Exists(name) || *mode != 'r') return nullptr;
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size());
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::string_view bytes_;
  std::string name_;
};

// Removes all other loaders, so that the file's extension alone decides how it is read.
void keep_only_loader(Assimp::Importer& importer, const std::string& extension) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* const loader = importer.GetImporter(i);
    std::set<std::string> extensions;
    loader->GetExtensionList(extensions);
    if (extensions.contains(extension)) continue;
    importer.UnregisterLoader(loader);
    delete loader;  // no longer the importer's
  }
}

// Assimp's Collada reader recurses into elements and instances of nodes without a limit, takes any file with a ZIP
// directory at its end for an archive, trusts the array lengths in accessors, the counts of primitives and the bones in
// skins, and reads the lists <p> and <vcount> without end if they hold anything but numbers. Expat, which has limits,
// checks the file first. Both must see the same content: a document type, whose entities and defaults only Expat
// resolves, is refused.
struct ColladaCheck {
  static constexpr int kMostNested = 100;
  struct Accessor {
    std::string array;
    std::uint64_t reach;  // number of the array's values that it spans
    std::uint64_t stride;
    XML_Size line;
  };
  int depth = 0;
  bool in_accessor = false;
  std::uint64_t parameters = 0;  // of this accessor
  std::uint64_t bytes = 0;       // of the file
  std::uint64_t primitives = 0;  // triangles or the like that the enclosing element counts
  bool in_indices = false;       // in a list of whole numbers
  const char* refusal = nullptr;
  std::map<std::string, std::uint64_t> array_lengths;
  std::vector<Accessor> accessors;
  XML_Parser parser = nullptr;
};

std::string_view attribute(const XML_Char** attributes, std::string_view name) {
  for (; *attributes; attributes += 2)
    if (attributes[0] == name) return attributes[1];
  return {};
}

// At most 32 bits, so that a count times a stride fits into 64.
std::uint64_t count_in(ColladaCheck& check, std::string_view text, std::uint32_t otherwise) {
  std::uint32_t count = otherwise;
  if (text.empty()) return count;
  if (const auto [end, error] = std::from_chars(text.begin(), text.end(), count);
      error != std::errc() || end != text.end())
    check.refusal = "has a count, stride or offset that is not a whole number";
  return count;
}

void collada_start(void* user, const XML_Char* element, const XML_Char** attributes) {
  // Unsupported elements, and too deep nesting.
  auto& check = *static_cast<ColladaCheck*>(user);
  const std::string_view name = element;
  if (++check.depth > ColladaCheck::kMostNested) check.refusal = "has elements nested more than 100 deep";
  if (name == "controller" || name == "animation")
    check.refusal = "has skins or animations, which are not supported; export the mesh alone";
  if (name == "instance_node")
    check.refusal =
        "has an <instance_node>, which is not supported; export the nodes themselves, or an OBJ or STL file";

  // Each primitive has at least one index for each offset of its inputs, and each index takes at least one byte.
  const std::string_view count = attribute(attributes, "count");
  constexpr std::array<std::string_view, 7> kPrimitives{"lines",     "linestrips", "polygons", "polylist",
                                                        "triangles", "trifans",    "tristrips"};
  if (std::ranges::find(kPrimitives, name) != kPrimitives.end()) check.primitives = count_in(check, count, 0);
  const std::uint64_t last_offset = name == "input" ? count_in(check, attribute(attributes, "offset"), 0) : 0;
  if (check.primitives * (last_offset + 1) > check.bytes)
    check.refusal = "counts more primitives than a file of this size can have";
  if (name == "p" || name == "vcount") check.in_indices = true;

  // Arrays and accessors are collected, to be compared at the end of the file.
  if (name.ends_with("_array")) {
    // Only a float_array holds numbers. If two have one id, assimp may use either: the shorter one counts.
    const std::uint64_t length = name == "float_array" ? count_in(check, count, 0) : 0;
    const auto [array, first] = check.array_lengths.try_emplace(std::string(attribute(attributes, "id")), length);
    if (!first) array->second = std::min(array->second, length);
  } else if (name == "accessor") {
    if (check.in_accessor) check.refusal = "has an <accessor> in an <accessor>";
    const std::uint64_t offset = count_in(check, attribute(attributes, "offset"), 0);
    const std::uint64_t stride = count_in(check, attribute(attributes, "stride"), 1);
    std::string_view source = attribute(attributes, "source");
    if (source.starts_with('#')) source.remove_prefix(1);
    // A stride of 0 still spans one value.
    const std::uint64_t reach = offset + std::max<std::uint64_t>(stride, 1) * count_in(check, count, 0);
    check.accessors.push_back({std::string(source), reach, stride, line_of(check.parser)});
    check.in_accessor = true;
    check.parameters = 0;
  } else if (name == "param" && check.in_accessor && ++check.parameters > check.accessors.back().stride) {
    check.refusal = "has an <accessor> with more parameters than its stride";
  }
  if (check.refusal) XML_StopParser(check.parser, XML_FALSE);
}

void collada_end(void* user, const XML_Char* element) {
  auto& check = *static_cast<ColladaCheck*>(user);
  --check.depth;
  const std::string_view name = element;
  if (name == "accessor") check.in_accessor = false;
  if (name == "p" || name == "vcount") check.in_indices = false;
}

void collada_text(void* user, const XML_Char* text, int length) {
  auto& check = *static_cast<ColladaCheck*>(user);
  constexpr std::string_view kOfWholeNumbers = "0123456789+- \t\r\n";
  if (!check.in_indices ||
      std::string_view(text, static_cast<std::size_t>(length)).find_first_not_of(kOfWholeNumbers) ==
          std::string_view::npos)
    return;
  check.refusal = "has something other than whole numbers in a <p> or <vcount>";
  XML_StopParser(check.parser, XML_FALSE);
}

void collada_document_type(void* user, const XML_Char*, const XML_Char*, const XML_Char*, int) {
  auto& check = *static_cast<ColladaCheck*>(user);
  check.refusal = "has a document type, which is not supported; leave out its <!DOCTYPE>";
  XML_StopParser(check.parser, XML_FALSE);
}

void check_collada(std::string_view bytes) {
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr), XML_ParserFree);
  ColladaCheck check;
  check.parser = parser.get();
  check.bytes = bytes.size();
  XML_SetUserData(parser.get(), &check);
  XML_SetElementHandler(parser.get(), collada_start, collada_end);
  XML_SetCharacterDataHandler(parser.get(), collada_text);
  XML_SetStartDoctypeDeclHandler(parser.get(), collada_document_type);

  // A well-formed file: no accessor may span more than its array has.
  if (XML_Parse(parser.get(), bytes.data(), static_cast<int>(bytes.size()), 1) == XML_STATUS_OK) {
    for (const ColladaCheck::Accessor& accessor : check.accessors) {
      const auto array = check.array_lengths.find(accessor.array);
      if (array != check.array_lengths.end() && accessor.reach > array->second)
        throw description::DescriptionError(fmt::format("has an <accessor> of {} values of an array of {} (line {})",
                                                        accessor.reach, array->second, accessor.line));
    }
    return;
  }
  if (check.refusal)
    throw description::DescriptionError(fmt::format("{} (line {})", check.refusal, line_of(parser.get())));
  throw description::DescriptionError(fmt::format("is not a well-formed Collada file: {} (line {})",
                                                  XML_ErrorString(XML_GetErrorCode(parser.get())),
                                                  line_of(parser.get())));
}

// Assimp's ear clipping takes quadratic time or more in the corners of a polygon.
void check_polygons(const aiScene& scene) {
  constexpr unsigned kMostCorners = 500;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      if (mesh.mFaces[f].mNumIndices > kMostCorners)
        throw description::DescriptionError(fmt::format("has a polygon of {} corners, of at most {}: triangulate it",
                                                        mesh.mFaces[f].mNumIndices, kMostCorners));
  }
}

Eigen::Affine3d from_assimp(const aiMatrix4x4& m) {
  Eigen::Affine3d X;
  X.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2, m.d3, m.d4;
  return X;
}

class Collector {
 public:
  Collector(const aiScene& scene, const MeshPart& part, std::size_t most_triangles)
      : scene_(scene), part_(part), most_triangles_(most_triangles) {}

  // Visits nodes depth first, without recursion; below a node of the wanted name all meshes count.
  MeshContent collect() {
    struct Entry {
      const aiNode* node;
      Eigen::Affine3d X_FileParent;
      bool wanted;
    };
    std::vector<Entry> open{{scene_.mRootNode, Eigen::Affine3d::Identity(), part_.submesh.empty()}};
    while (!open.empty()) {
      const auto [node, X_FileParent, parent_wanted] = open.back();
      open.pop_back();
      const Eigen::Affine3d X_FileNode = X_FileParent * from_assimp(node->mTransformation);
      const bool wanted = parent_wanted || has_name(node->mName);
      for (unsigned m = 0; m < node->mNumMeshes; ++m) {
        const aiMesh& mesh = *scene_.mMeshes[node->mMeshes[m]];
        if (mesh.mName.length > 0) names_.insert(mesh.mName.C_Str());
        if (wanted || has_name(mesh.mName)) append(mesh, X_FileNode);
      }
      for (unsigned c = node->mNumChildren; c-- > 0;) open.push_back({node->mChildren[c], X_FileNode, wanted});
    }
    if (content_.surface.triangles.empty()) refuse_empty();
    if (part_.centred) centre();
    return std::move(content_);
  }

 private:
  bool has_name(const aiString& name) const { return !part_.submesh.empty() && part_.submesh == name.C_Str(); }

  void append(const aiMesh& mesh, const Eigen::Affine3d& X_FileNode) {
    std::vector<Eigen::Vector3d>& vertices = content_.surface.vertices;
    // Limits also for lines, points and the rest of polygons that could not be triangulated: instances multiply them.
    constexpr std::size_t kCorners = 3;
    if (mesh.mNumFaces > most_triangles_ - content_.surface.triangles.size() - content_.other_faces ||
        mesh.mNumVertices > kCorners * most_triangles_ - vertices.size())
      throw description::DescriptionError(
          fmt::format("has more triangles than the {} that are left for this world", most_triangles_));

    // Vertices in the file's frame, then triangles; a node that mirrors turns their winding round.
    const std::size_t first = vertices.size();
    const bool mirrored = X_FileNode.linear().determinant() < 0;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      vertices.emplace_back(X_FileNode * Eigen::Vector3d(p.x, p.y, p.z));
      if (!vertices.back().allFinite()) throw description::DescriptionError("has a vertex that is not a number");
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) {
        ++content_.other_faces;
        continue;
      }
      std::array<std::uint32_t, 3> triangle{};
      for (unsigned i = 0; i < 3; ++i) {
        if (face.mIndices[i] >= mesh.mNumVertices)
          throw description::DescriptionError("has a triangle with a missing vertex");
        triangle[mirrored ? 2 - i : i] = static_cast<std::uint32_t>(first + face.mIndices[i]);
      }
      content_.surface.triangles.push_back(triangle);
    }
  }

  [[noreturn]] void refuse_empty() const {
    if (part_.submesh.empty()) throw description::DescriptionError("has no triangles");
    throw description::DescriptionError(fmt::format("has no submesh \"{}\" with triangles; its meshes are: {}",
                                                    part_.submesh, fmt::join(names_, ", ")));
  }

  void centre() {
    Eigen::AlignedBox3d bounds;
    for (const Eigen::Vector3d& p : content_.surface.vertices) bounds.extend(p);
    const Eigen::Vector3d middle = bounds.center();
    for (Eigen::Vector3d& p : content_.surface.vertices) p -= middle;
  }

  const aiScene& scene_;
  const MeshPart& part_;
  std::size_t most_triangles_;
  MeshContent content_;
  std::set<std::string> names_;
};

}  // namespace

MeshContent read_mesh(std::string_view bytes, MeshFormat format, const MeshPart& part, std::size_t most_triangles) {
  if (bytes.empty()) throw description::DescriptionError("is an empty file");
  if (format == MeshFormat::dae) check_collada(bytes);
  const std::string extension = extension_of(format), name = "mesh." + extension;
  try {
    Assimp::Importer importer;
    keep_only_loader(importer, extension);
    importer.SetIOHandler(new OneFile(bytes, name));  // the importer deletes it
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    const aiScene* scene = importer.ReadFile(name, 0);
    if (scene) {
      check_polygons(*scene);
      scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    }
    if (!scene || !scene->mRootNode)
      throw description::DescriptionError(
          fmt::format("cannot be read as a .{} mesh: {}", extension, importer.GetErrorString()));
    return Collector(*scene, part, most_triangles).collect();
  } catch (const description::DescriptionError&) {
    throw;
  } catch (const std::exception& error) {
    throw description::DescriptionError(fmt::format("cannot be read as a .{} mesh: {}", extension, error.what()));
  }
}

}  // namespace kenaf::physics
