// Shapes, meshes and height maps become triangles. Their volumes, chords, orientation and heights are checked against
// the closed forms of the shapes and the pixels of small pictures. Files are found in the world's folders only, and any
// file or size that makes no sense is refused with its place.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "physics/mesh_file.hpp"
#include "physics/triangle_surface.hpp"
#include "physics/world_description.hpp"
#include "tests/formats/runs/temporary_folder.hpp"

using namespace kenaf::physics;
using kenaf::test::TemporaryFolder;
using kenaf::test::write_file;
namespace fs = std::filesystem;

namespace {

constexpr double kPi = std::numbers::pi;

// The shape is on line 3.
std::string world_of(const std::string& shape, const std::string& pose = "0 0 0 0 0 0") {
  return "<sdf version=\"1.9\"><world name=\"w\">\n<model name=\"m\"><static>true</static><pose>" + pose +
         "</pose><link name=\"l\"><collision name=\"c\"><geometry>\n" + shape +
         "\n</geometry><surface><friction><ode><mu>0.7</mu></ode></friction></surface></collision></link></model>"
         "</world></sdf>";
}

TriangleMesh mesh_of(const std::string& shape, const fs::path& folder = "", const std::string& pose = "0 0 0 0 0 0") {
  std::vector<std::string> unsupported;
  const WorldDescription world = parse_world(world_of(shape, pose), "t.sdf", folder, unsupported);
  CHECK(unsupported.empty());
  REQUIRE(world.meshes.size() == 1);
  return world.meshes[0];
}

std::string error_of_shape(const std::string& shape, const fs::path& folder = "") {
  std::vector<std::string> unsupported;
  try {
    parse_world(world_of(shape), "t.sdf", folder, unsupported);
  } catch (const kenaf::description::DescriptionError& error) {
    return error.what();
  }
  return "";
}

double volume(const TriangleMesh& mesh) {
  return volume_m3({mesh.vertices_W, mesh.triangles});
}

Eigen::AlignedBox3d bounds(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : mesh.vertices_W) box.extend(p);
  return box;
}

bool is_closed(const TriangleMesh& mesh) {
  TriangleSurface surface{mesh.vertices_W, mesh.triangles};
  return tidy(surface).closed;
}

// A tetrahedron with legs of 1 along the axes from (0, 0, 0): volume 1/6. `outward`: as its faces should be wound.
std::string tetrahedron_obj(bool outward = true) {
  const std::string corners = "o tetrahedron\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  return corners + (outward ? "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n" : "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
}

std::string collada(const std::string& nodes, const std::string& unit = "1") {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="u" meter=")" +
         unit + R"("/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="wedge" name="wedge"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">)" +
         nodes + R"(</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string node(const std::string& name, const std::string& translation) {
  return "<node id=\"" + name + "\" name=\"" + name + "\"><translate>" + translation +
         "</translate><instance_geometry url=\"#wedge\"/></node>";
}

// What read_mesh() says of a Collada file in which `was` is replaced.
std::string collada_error(const std::string& was, const std::string& is) {
  std::string text = collada(node("a", "0 0 0"));
  text.replace(text.find(was), was.size(), is);
  try {
    read_mesh(text, MeshFormat::dae, {}, 1000);
  } catch (const kenaf::description::DescriptionError& error) {
    return error.what();
  }
  return "";
}

std::string from_hex(const std::string& digits) {
  std::string bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2)
    bytes.push_back(static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16)));
  return bytes;
}

// PNG pictures, written with Python's zlib.
const std::string kGrey8 = from_hex(  // 0 50 100 / 150 200 250
    "89504e470d0a1a0a0000000d4948445200000003000000020800000000b81f39c6000000104944415478da6360304a61"
    "9876e21700077402efbcc39f540000000049454e44ae426082");
const std::string kGrey16 = from_hex(  // 0 258 / 1000 40000
    "89504e470d0a1a0a0000000d4948445200000002000000021000000000074d8ebb000000124944415478da6360606064"
    "62607e31c70100045901cbb9f7ce4b0000000049454e44ae426082");
const std::string kColour = from_hex(  // 2 x 2 pixels
    "89504e470d0a1a0a0000000d4948445200000002000000020802000000fdd49a730000000b4944415478da6360400600"
    "000e00013a3504560000000049454e44ae426082");

}  // namespace

TEST_CASE("A cylinder is closed, outward, and its chords stay within 1 mm") {
  const TriangleMesh mesh = mesh_of("<cylinder><radius>0.15</radius><length>2</length></cylinder>");
  CHECK(is_closed(mesh));
  CHECK(mesh.friction == 0.7);
  // inscribed: smaller than the cylinder, but no smaller than one whose radius is 1 mm less
  CHECK(volume(mesh) < kPi * 0.15 * 0.15 * 2);
  CHECK(volume(mesh) > kPi * 0.149 * 0.149 * 2);
  CHECK(bounds(mesh).max().z() == Approx(1));
  CHECK(bounds(mesh).min().z() == Approx(-1));
}

TEST_CASE("Spheres, capsules and ellipsoids are closed and of the right volume") {
  const TriangleMesh sphere = mesh_of("<sphere><radius>0.5</radius></sphere>");
  CHECK(is_closed(sphere));
  CHECK(volume(sphere) < 4.0 / 3 * kPi * std::pow(0.5, 3));
  CHECK(volume(sphere) > 4.0 / 3 * kPi * std::pow(0.499, 3));
  const TriangleMesh capsule = mesh_of("<capsule><radius>0.5</radius><length>1</length></capsule>");
  CHECK(is_closed(capsule));
  CHECK(volume(capsule) == Approx(volume(sphere) + kPi * 0.25).epsilon(2e-3));
  CHECK(bounds(capsule).sizes().isApprox(Eigen::Vector3d(1, 1, 2), 1e-9));
  const TriangleMesh ellipsoid = mesh_of("<ellipsoid><radii>0.5 0.2 0.1</radii></ellipsoid>");
  CHECK(is_closed(ellipsoid));
  CHECK(volume(ellipsoid) == Approx(4.0 / 3 * kPi * 0.5 * 0.2 * 0.1).epsilon(6e-3));
}

TEST_CASE("All shapes' sides face outward, wherever they are cut") {
  for (const char* shape :
       {"<cylinder><radius>0.1</radius><length>1</length></cylinder>", "<sphere><radius>0.1</radius></sphere>",
        "<capsule><radius>0.1</radius><length>1</length></capsule>"}) {
    const TriangleMesh mesh = mesh_of(shape);
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3d &a = mesh.vertices_W[t[0]], &b = mesh.vertices_W[t[1]], &c = mesh.vertices_W[t[2]];
      CHECK((b - a).cross(c - a).dot(a + b + c) > 0);  // convex about the origin
    }
  }
}

TEST_CASE("A polyline is extruded upward, in either sense of rotation") {
  // an L of 3 unit squares
  const std::string l_shape =
      "<point>0 0</point><point>2 0</point><point>2 1</point><point>1 1</point><point>1 2</point><point>0 2</point>";
  const TriangleMesh mesh = mesh_of("<polyline>" + l_shape + "<height>0.5</height></polyline>");
  CHECK(is_closed(mesh));
  CHECK(volume(mesh) == Approx(1.5));
  CHECK(bounds(mesh).min().z() == 0);
  CHECK(bounds(mesh).max().z() == 0.5);
  const TriangleMesh turned = mesh_of(
      "<polyline><point>0 0</point><point>0 2</point><point>1 2</point><point>1 1</point><point>2 1</point>"
      "<point>2 0</point><point>1 0</point><point>0 0</point><height>0.5</height></polyline>");
  CHECK(is_closed(turned));
  CHECK(volume(turned) == Approx(1.5));
}

TEST_CASE("A shape stands where its model puts it") {
  // lies along y, 1 m ahead
  const TriangleMesh mesh =
      mesh_of("<cylinder><radius>0.1</radius><length>4</length></cylinder>", "", "1 0 0 1.5707963267948966 0 0");
  CHECK(bounds(mesh).max().y() == Approx(2));
  CHECK(bounds(mesh).min().x() == Approx(0.9).margin(1e-3));
}

TEST_CASE("An OBJ mesh is scaled, and its triangles are turned outward") {
  const TemporaryFolder folder;
  write_file(folder / "right.obj", tetrahedron_obj());
  fs::create_directory(folder / "meshes");
  write_file(folder / "meshes/inside-out.OBJ", tetrahedron_obj(false));
  const TriangleMesh mesh = mesh_of("<mesh><uri>right.obj</uri></mesh>", folder.path());
  CHECK(mesh.triangles.size() == 4);
  CHECK(mesh.vertices_W.size() == 4);
  CHECK(volume(mesh) == Approx(1.0 / 6));
  CHECK(volume(mesh_of("<mesh><uri>meshes/inside-out.OBJ</uri></mesh>", folder.path())) == Approx(1.0 / 6));
  const TriangleMesh scaled = mesh_of("<mesh><uri>right.obj</uri><scale>2 3 -1</scale></mesh>", folder.path());
  CHECK(volume(scaled) == Approx(1));
  CHECK(bounds(scaled).min().isApprox(Eigen::Vector3d(0, 0, -1)));
}

TEST_CASE("Polygons are cut into triangles, what has no area is dropped and said") {
  const TemporaryFolder folder;
  write_file(folder / "quad.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 1 0 0\nf 1 2 3 4\nf 1 5 2\nl 1 2\n");
  std::vector<std::string> unsupported;
  const auto world = parse_world(world_of("<mesh><uri>quad.obj</uri></mesh>"), "t.sdf", folder.path(), unsupported);
  REQUIRE(world.meshes.size() == 1);
  CHECK(world.meshes[0].triangles.size() == 2);
  REQUIRE(unsupported.size() == 2);
  CHECK(unsupported[0].find("t.sdf:3: \"quad.obj\": 1 points and lines") == 0);
  CHECK(unsupported[1].find("t.sdf:3: 1 triangles without area") == 0);
}

TEST_CASE("Neighbours that disagree on what is outside are named") {
  const TemporaryFolder folder;
  write_file(folder / "odd.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 4 3\n");
  std::vector<std::string> unsupported;
  parse_world(world_of("<mesh><uri>odd.obj</uri></mesh>"), "t.sdf", folder.path(), unsupported);
  REQUIRE(unsupported.size() == 1);
  CHECK(unsupported[0].find("do not agree on which side") != std::string::npos);
}

TEST_CASE("An STL mesh is read as text and in binary") {
  const TemporaryFolder folder;
  write_file(folder / "text.stl",
             "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
             "endfacet\nendsolid s\n");
  std::string binary(84, ' ');
  const auto append = [&](auto value) { binary.append(reinterpret_cast<const char*>(&value), sizeof value); };
  const std::uint32_t count = 1;
  binary.replace(80, 4, reinterpret_cast<const char*>(&count), 4);
  for (const float f : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) append(f);
  append(std::uint16_t{0});
  write_file(folder / "binary.stl", binary);
  for (const char* name : {"text.stl", "binary.stl"}) {
    const TriangleMesh mesh = mesh_of(std::string("<mesh><uri>") + name + "</uri></mesh>", folder.path());
    REQUIRE(mesh.triangles.size() == 1);
    CHECK(bounds(mesh).max().isApprox(Eigen::Vector3d(1, 1, 0)));
  }
}

TEST_CASE("A Collada mesh is read with its unit, nodes and submesh") {
  const TemporaryFolder folder;
  write_file(folder / "cm.dae", collada(node("a", "100 0 0") + node("b", "0 500 0"), "0.01"));
  const TriangleMesh both = mesh_of("<mesh><uri>cm.dae</uri></mesh>", folder.path());
  CHECK(both.triangles.size() == 2);
  CHECK(bounds(both).max().isApprox(Eigen::Vector3d(1.01, 5.01, 0), 1e-6));
  const std::string only_b = "<mesh><uri>cm.dae</uri><submesh><name>b</name>";
  const TriangleMesh b = mesh_of(only_b + "</submesh></mesh>", folder.path());
  REQUIRE(b.triangles.size() == 1);
  CHECK(bounds(b).min().isApprox(Eigen::Vector3d(0, 5, 0), 1e-6));
  const TriangleMesh centred = mesh_of(only_b + "<center>true</center></submesh></mesh>", folder.path());
  CHECK(bounds(centred).min().isApprox(Eigen::Vector3d(-0.005, -0.005, 0), 1e-6));
  CHECK(error_of_shape("<mesh><uri>cm.dae</uri><submesh><name>c</name></submesh></mesh>", folder.path())
            .find("t.sdf:3: \"cm.dae\" has no submesh \"c\"") == 0);
}

TEST_CASE("A height map: the top row is +y, the brightest pixel is as high as its size says") {
  const TemporaryFolder folder;
  write_file(folder / "grey8.png", kGrey8);
  const TriangleMesh mesh =
      mesh_of("<heightmap><uri>grey8.png</uri><size>4 2 0.5</size><pos>10 20 1</pos></heightmap>", folder.path());
  REQUIRE(mesh.vertices_W.size() == 6);
  CHECK(mesh.triangles.size() == 4);
  const auto height_at = [&](double x, double y) {
    for (const Eigen::Vector3d& p : mesh.vertices_W)
      if (std::abs(p.x() - x) + std::abs(p.y() - y) < 1e-9) return p.z();
    return -1.0;
  };
  CHECK(height_at(8, 21) == Approx(1));     // first pixel of the top row: black
  CHECK(height_at(12, 21) == Approx(1.2));  // last: 100 of 250
  CHECK(height_at(8, 19) == Approx(1.3));   // first pixel of the bottom row: 150 of 250
  CHECK(height_at(12, 19) == Approx(1.5));
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices_W[t[0]], &b = mesh.vertices_W[t[1]], &c = mesh.vertices_W[t[2]];
    CHECK((b - a).cross(c - a).z() > 0);
  }
}

TEST_CASE("16 bits are read whole, high byte first") {
  const TemporaryFolder folder;
  write_file(folder / "grey16.png", kGrey16);
  const TriangleMesh mesh = mesh_of("<heightmap><uri>grey16.png</uri><size>1 1 40</size></heightmap>", folder.path());
  double second = 0;
  for (const Eigen::Vector3d& p : mesh.vertices_W)
    if (p.x() > 0 && p.y() > 0) second = p.z();
  CHECK(second == Approx(0.258));
}

TEST_CASE("Files are found in the world's folder, however they are named") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "meshes");
  write_file(folder / "meshes/a.obj", tetrahedron_obj());
  for (const char* uri : {"meshes/a.obj", "model://meshes/a.obj", "file://meshes/a.obj", "./meshes/../meshes/a.obj"})
    CHECK(mesh_of("<mesh><uri>" + std::string(uri) + "</uri></mesh>", folder.path()).triangles.size() == 4);
  CHECK(mesh_of("<mesh><uri>file://" + (folder.path() / "meshes/a.obj").string() + "</uri></mesh>", folder.path())
            .triangles.size() == 4);
}

TEST_CASE("Nothing outside of the world's folder is read") {
  const TemporaryFolder outer;
  write_file(outer / "secret.obj", tetrahedron_obj());
  fs::create_directory(outer / "meshes");
  write_file(outer / "meshes/mine.obj", "mtllib ../secret.obj\n" + tetrahedron_obj());
  const fs::path folder = outer.path() / "meshes";
  fs::create_symlink(outer.path() / "secret.obj", folder / "link.obj");
  const auto error = [&](const std::string& uri) {
    return error_of_shape("<mesh><uri>" + uri + "</uri></mesh>", folder);
  };
  for (const std::string& uri : {std::string("../secret.obj"), std::string("file://../secret.obj"),
                                 (outer.path() / "secret.obj").string(), std::string("link.obj")}) {
    INFO(uri);
    CHECK(error(uri).find("t.sdf:3: \"" + uri + "\" is not in a folder of this world") == 0);
  }
  CHECK(error("https://example.org/a.obj").find("no https://") != std::string::npos);
  CHECK(error("gone.obj").find("t.sdf:3: \"gone.obj\": there is no such file") == 0);
  CHECK(error(".").find("must be a .stl, .obj or .dae file") != std::string::npos);
  CHECK(mesh_of("<mesh><uri>mine.obj</uri></mesh>", folder).triangles.size() == 4);  // without its materials
  CHECK(error_of_shape("<mesh><uri>mine.obj</uri></mesh>", "").find("has no folder") != std::string::npos);
}

TEST_CASE("Sizes that cannot be are refused with their line") {
  for (const char* shape :
       {"<sphere><radius>0</radius></sphere>", "<sphere><radius>nan</radius></sphere>",
        "<cylinder><radius>1</radius><length>-1</length></cylinder>",
        "<capsule><radius>1e9</radius><length>1</length></capsule>", "<ellipsoid><radii>1 0 1</radii></ellipsoid>",
        "<polyline><point>0 0</point><point>1 0</point><point>0 1</point><height>0</height></polyline>",
        "<polyline><point>0 0</point><point>1 0</point><point>2 0</point><height>1</height></polyline>",
        "<polyline><point>0 0</point><point>1 1</point><point>1 0</point><point>0 1</point>"
        "<height>1</height></polyline>"}) {
    INFO(shape);
    CHECK(error_of_shape(shape).find("t.sdf:3: ") == 0);
  }
}

TEST_CASE("Files that are not what they should be are refused with the line that names them") {
  const TemporaryFolder folder;
  const auto mesh_error = [&](const std::string& name, const std::string& bytes) {
    write_file(folder / name, bytes);
    return error_of_shape("<mesh><uri>" + name + "</uri></mesh>", folder.path());
  };
  const auto map_error = [&](const std::string& bytes, const std::string& size = "1 1 1") {
    write_file(folder / "a.png", bytes);
    return error_of_shape("<heightmap><uri>a.png</uri><size>" + size + "</size></heightmap>", folder.path());
  };
  for (const std::string& error :
       {mesh_error("a.stl", ""), mesh_error("a.stl", "no mesh"), mesh_error("a.obj", "v 0 0 0\n"),
        mesh_error("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), mesh_error("a.obj", "f 1 2 3\n"),
        mesh_error("a.dae", "<COLLADA>"), mesh_error("a.ply", tetrahedron_obj()), map_error(""), map_error("PNG"),
        map_error(kGrey8.substr(0, 50)), map_error(kColour), map_error(kGrey8, "0 1 1"),
        map_error(kGrey8, "1 1 nan")}) {
    INFO(error);
    CHECK(error.find("t.sdf:3: ") == 0);
  }
  CHECK(map_error(kColour).find("grey picture of 8 or 16 bits") != std::string::npos);
}

TEST_CASE("What would eat memory or stack is refused first") {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& name, const std::string& bytes) {
    write_file(folder / name, bytes);
    return error_of_shape("<mesh><uri>" + name + "</uri></mesh>", folder.path());
  };
  CHECK(error("large.stl", std::string((16U << 20U) + 1, 'x')).find("is larger than 16 MiB") != std::string::npos);
  const std::string instances =
      "<node id=\"a\"><instance_node url=\"#a\"/></node>";  // of itself; or doubled 60 times over
  CHECK(error("instances.dae", collada(instances)).find("<instance_node>") != std::string::npos);
  std::string nested;
  for (int i = 0; i < 1000; ++i) nested = "<node>" + nested + "</node>";
  CHECK(error("nested.dae", collada(nested)).find("nested more than 100 deep") != std::string::npos);
  const auto with = [&](const std::string& was, const std::string& is) {
    std::string text = collada(node("a", "0 0 0"));
    return text.replace(text.find(was), was.size(), is);
  };
  CHECK_THAT(error("short.dae", with("count=\"9\"", "count=\"0\"")),
             Catch::Contains("9 values of an array of 0 (line 6)"));
  CHECK(error("wide.dae", with("stride=\"3\"", "stride=\"2\"")).find("more parameters than its stride") !=
        std::string::npos);
  CHECK(error("words.dae", with("count=\"3\"", "count=\"three\"")).find("not a whole number") != std::string::npos);
  CHECK(error("letter.dae", with("0 1 2", "0 1G2")).find("other than whole numbers in a <p>") != std::string::npos);
  // a triangle is at least one byte of the file
  CHECK(error("many.dae", with("triangles count=\"1\"", "triangles count=\"4000000000\"")).find("counts more") !=
        std::string::npos);
  CHECK(error("far.dae", with("offset=\"0\"", "offset=\"4000000000\"")).find("counts more") != std::string::npos);
  // a picture that says it is 60000 x 60000
  std::string png = kGrey8;
  png.replace(16, 8, std::string("\0\0\xea\x60\0\0\xea\x60", 8));
  write_file(folder / "a.png", png);
  CHECK(error_of_shape("<heightmap><uri>a.png</uri></heightmap>", folder.path()).find("t.sdf:3: ") == 0);
}

// The accessor goes over 3 x 3 = 9 numbers of the array "pa", which is on line 5.
TEST_CASE("A Collada file cannot say that an array is longer than it is") {
  const std::string array = R"(<float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array>)";
  const auto error = [&](const std::string& is) { return collada_error(array, is); };
  CHECK(error(array) == "");
  for (const std::string name : {"Name_array", "IDREF_array"})
    CHECK_THAT(error("<" + name + " id=\"pa\" count=\"9\">0 0 0 1 0 0 0 1 0</" + name + ">"),
               Catch::Contains("9 values of an array of 0 (line 6)"));
  const std::string shorter = R"(<float_array id="pa" count="1">0</float_array>)";
  CHECK_THAT(error(array + shorter), Catch::Contains("9 values of an array of 1 (line 6)"));
  CHECK_THAT(error(shorter + array), Catch::Contains("9 values of an array of 1 (line 6)"));
  CHECK_THAT(error(shorter + R"(<foo_array id="pa" count="9"/>)"), Catch::Contains("9 values of an array of 0"));
  // with a stride of 0 an element still is a number
  const std::string accessor =
      R"(<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor>)";
  CHECK_THAT(collada_error(accessor, R"(<accessor source="#pa" count="10" stride="0"/>)"),
             Catch::Contains("10 values of an array of 9"));
  CHECK_THAT(collada_error(R"(stride="3">)", R"(stride="3"><accessor source="#pa"/>)"),
             Catch::Contains("has an <accessor> in an <accessor>"));
}

TEST_CASE("Collada with a document type, skins or animations is refused, empty libraries of them are not") {
  const std::string root = "<COLLADA ", geometries = "<library_geometries>";
  CHECK_THAT(collada_error(root, "<!DOCTYPE COLLADA [<!ATTLIST float_array count CDATA \"9\">]>\n" + root),
             Catch::Contains("has a document type"));
  CHECK_THAT(collada_error(root, "<!DOCTYPE COLLADA>\n" + root), Catch::Contains("has a document type"));
  const auto with_library = [&](const std::string& library) { return collada_error(geometries, library + geometries); };
  for (const char* library : {"<library_controllers><controller id=\"c\"/></library_controllers>",
                              "<library_animations><animation id=\"c\"/></library_animations>"})
    CHECK_THAT(with_library(library), Catch::Contains("has skins or animations") && Catch::Contains("(line 4)"));
  CHECK(with_library("<library_controllers/><library_animations/>") == "");
}

TEST_CASE("A polygon of more than 500 corners is not cut") {
  const auto error = [](int corners) -> std::string {
    std::string text, face = "f";
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * kPi * i / corners;
      text += "v " + std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
      face += " " + std::to_string(i + 1);
    }
    try {
      read_mesh(text + face + "\n", MeshFormat::obj, {}, 1000);
    } catch (const kenaf::description::DescriptionError& e) {
      return e.what();
    }
    return "";
  };
  CHECK(error(500) == "");
  CHECK_THAT(error(501), Catch::Contains("a polygon of 501 corners") && Catch::Contains("triangulate it"));
}

TEST_CASE("Lines and points count as triangles do, in every instance") {
  std::string text = collada(node("a", "0 0 0") + node("b", "1 0 0"));
  const std::string end = "</triangles>";
  text.insert(text.find(end) + end.size(),
              R"(<lines count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1</p></lines>)");
  // a triangle and a line, twice
  const MeshContent content = read_mesh(text, MeshFormat::dae, {}, 4);
  CHECK(content.surface.triangles.size() == 2);
  CHECK(content.other_faces == 2);
  CHECK_THROWS_AS(read_mesh(text, MeshFormat::dae, {}, 3), kenaf::description::DescriptionError);
}
