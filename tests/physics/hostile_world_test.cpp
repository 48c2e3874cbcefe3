// Worlds that would read what they must not, wait for ever or take all memory: each is refused, with its place, before
// it costs anything. A reader that waited for a pipe or read a device to its end would hang here.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "physics/world_description.hpp"
#include "tests/formats/runs/temporary_folder.hpp"

using namespace kenaf::physics;
using Catch::Contains;
using kenaf::test::TemporaryFolder;
using kenaf::test::write_file;
namespace fs = std::filesystem;

namespace {

std::string world_with(const std::string& inside) {
  return "<sdf version=\"1.9\"><world name=\"w\">\n" + inside + "\n</world></sdf>";
}

std::string include(const std::string& uri, const std::string& name = "") {
  return "<include><uri>" + uri + "</uri>" + (name.empty() ? "" : "<name>" + name + "</name>") + "</include>\n";
}

std::string model(const std::string& name, const std::string& inside) {
  return "<model name=\"" + name + "\"><static>true</static>" + inside + "</model>\n";
}

std::string model_file(const std::string& inside) {
  return "<sdf version=\"1.9\">" + model("m", inside) + "</sdf>";
}

std::string link(const std::string& inside) {
  return "<link name=\"l\">" + inside + "</link>";
}

std::string shape(const std::string& geometry, int number = 0) {
  return "<collision name=\"c" + std::to_string(number) + "\"><geometry>" + geometry + "</geometry></collision>";
}

const std::string kBox = "<box><size>1 1 1</size></box>";

const std::string kLoads = "loads";

// What is said of a world in `folder`.
std::string error_of(const std::string& text, const fs::path& folder = "", const std::vector<fs::path>& search = {}) {
  std::vector<std::string> notes;
  try {
    parse_world(text, "w.sdf", folder, notes, search);
  } catch (const kenaf::description::DescriptionError& error) {
    return error.what();
  }
  return kLoads;
}

void make_huge(const fs::path& file) {
  write_file(file, "");
  fs::resize_file(file, std::uintmax_t{1} << 30U);  // sparse: takes no disk
}

std::size_t peak_memory_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "VmHWM:") {
      std::size_t kib = 0;
      status >> kib;
      return kib << 10U;
    }
  return 0;
}

}  // namespace

TEST_CASE("Pipes, devices, folders and files of 1 GB are no worlds", "[hostile]") {
  const TemporaryFolder folder;
  REQUIRE(::mkfifo((folder / "pipe.sdf").c_str(), 0600) == 0);
  fs::create_symlink("/dev/zero", folder / "endless.sdf");
  fs::create_directory(folder / "folder.sdf");
  make_huge(folder / "huge.sdf");
  fs::create_symlink(folder / "loop.sdf", folder / "loop.sdf");
  std::vector<std::string> notes;
  for (const char* name : {"pipe.sdf", "endless.sdf", "folder.sdf", "huge.sdf", "loop.sdf"})
    CHECK_THROWS_WITH(load_world((folder / name).string(), notes), Contains(name));
}

TEST_CASE("Pipes, devices and files of 1 GB are no models, meshes and height maps", "[hostile]") {
  const TemporaryFolder outer;
  const fs::path folder = outer / "world";
  for (const char* model : {"pipe", "endless", "huge"}) fs::create_directories(folder / model);
  const auto add = [&](const std::string& name) {
    REQUIRE(::mkfifo((folder / "pipe" / name).c_str(), 0600) == 0);
    fs::create_symlink("/dev/zero", folder / "endless" / name);
    make_huge(folder / "huge" / name);
  };
  for (const char* name : {"model.sdf", "rock.stl", "hills.png"}) add(name);
  const std::vector<std::string> folders{"pipe", "endless", "huge"},
      why{"not a file", "is not in a folder", "is larger than"};
  const auto check = [&](const std::string& before, const std::string& after) {
    for (std::size_t i = 0; i < folders.size(); ++i)
      CHECK_THAT(error_of(world_with(before + folders[i] + after), folder),
                 Catch::StartsWith("w.sdf:2: ") && Contains(folders[i]) && Contains(why[i]));
  };
  check("<include><uri>model://", "</uri></include>");
  check("<include><uri>", "/model.sdf</uri></include>");
  check("<model name=\"m\"><static>1</static><link name=\"l\"><collision name=\"c\"><geometry><mesh><uri>",
        "/rock.stl</uri></mesh></geometry></collision></link></model>");
  check("<model name=\"m\"><static>1</static><link name=\"l\"><collision name=\"c\"><geometry><heightmap><uri>",
        "/hills.png</uri></heightmap></geometry></collision></link></model>");
  add("model.config");
  check("<include><uri>model://", "</uri></include>");
}

TEST_CASE("No include leads out of the folders that are named", "[hostile]") {
  const TemporaryFolder outer;
  const fs::path folder = outer / "world", search = outer / "search";
  for (const char* name : {"world/way/in", "world/config", "world/linked", "search/far", "secret"})
    fs::create_directories(outer / name);
  const std::string model = model_file(link(shape(kBox)));
  write_file(outer / "secret/model.sdf", model);
  write_file(search / "far/model.sdf", model);
  fs::create_symlink(outer / "secret", folder / "link");
  fs::create_symlink(outer / "secret/model.sdf", folder / "linked/model.sdf");
  write_file(folder / "config/model.config", "<model><sdf version=\"1.9\">../../secret/model.sdf</sdf></model>");
  write_file(folder / "way/model.sdf", model_file(include("../../secret")));
  for (const std::string& uri :
       {std::string("../secret"), std::string("model://../secret"), std::string("file://../secret/model.sdf"),
        (outer / "secret").string(), (outer / "secret/model.sdf").string(), std::string("link"),
        std::string("model://link/model.sdf"), std::string("linked"), std::string("config"), std::string("way"),
        std::string("/etc/passwd"), std::string("/dev/zero"), std::string("file:///proc/self/mem"),
        std::string("way/../../secret")}) {
    INFO(uri);
    const std::string error = error_of(world_with(include(uri)), folder, {search});
    CHECK_THAT(error, Contains("is not in a folder of this world"));
    CHECK_THAT(error, Contains("w.sdf:2: ") || Contains("way/model.sdf:1: "));
  }
  // What is in the search path is read, and only by those that have it.
  CHECK(error_of(world_with(include("far")), folder, {search}) == kLoads);
  CHECK(error_of(world_with(include("../search/far")), folder, {search}) == kLoads);
  CHECK_THAT(error_of(world_with(include("../search/far")), folder), Contains("is not in a folder"));
}

TEST_CASE("A file that includes itself is refused with the chain of files", "[hostile]") {
  const TemporaryFolder folder;
  const fs::path real = fs::canonical(folder.path());
  for (const char* name : {"a", "b", "c"}) fs::create_directory(folder / name);
  write_file(folder / "a/model.sdf", model_file("\n" + include("model://b")));
  write_file(folder / "b/model.sdf", model_file(include("model://c")));
  write_file(folder / "c/model.sdf", model_file(include("model://a")));
  const auto file = [&](const char* name) { return (real / name / "model.sdf").string(); };
  CHECK(error_of(world_with(include("a")), folder.path()) == file("c") + ":1: a file includes itself: " + file("a") +
                                                                 " includes " + file("b") + " includes " + file("c") +
                                                                 " includes " + file("a"));
  write_file(folder / "a/model.sdf", model_file(include("model.sdf")));
  CHECK_THAT(error_of(world_with(include("a")), folder.path()), Contains(file("a") + " includes " + file("a")));

  // A world too, by whatever name.
  write_file(folder / "w.sdf", world_with(include("w.sdf")));
  fs::create_symlink("w.sdf", folder / "v.sdf");
  std::vector<std::string> notes;
  for (const char* name : {"w.sdf", "v.sdf"})
    CHECK_THROWS_WITH(load_world((folder / name).string(), notes), Contains(":2: a file includes itself: "));
}

TEST_CASE("Models are nested 16 deep and no deeper, in one file or many", "[hostile]") {
  const auto nested = [](int depth) {
    std::string text = link(shape(kBox));
    for (int i = depth; i > 0; --i) text = model("m" + std::to_string(i), text);
    return world_with(text);
  };
  CHECK(error_of(nested(16)) == kLoads);
  CHECK(error_of(nested(17)) == "w.sdf:2: models are nested more than 16 deep");
  CHECK_THAT(error_of(nested(5000)), Contains("w.sdf"));

  const TemporaryFolder folder;
  const auto file = [&](int level) { return folder / ("m" + std::to_string(level) + ".sdf"); };
  write_file(file(17), model_file(link(shape(kBox))));
  for (int level = 16; level > 0; --level)
    write_file(file(level), model_file(include(file(level + 1).filename().string())));
  CHECK(error_of(world_with(include("m2.sdf")), folder.path()) == kLoads);
  CHECK_THAT(error_of(world_with(include("m1.sdf")), folder.path()),
             Contains("m16.sdf:1: models are nested more than 16 deep"));
}

// 2^15 models from 15 small files.
TEST_CASE("Models that double at each include end at the limit of models", "[hostile]") {
  const TemporaryFolder folder;
  write_file(folder / "m15.sdf", model_file(link("")));
  for (int level = 14; level > 0; --level) {
    const std::string next = "m" + std::to_string(level + 1) + ".sdf";
    write_file(folder / ("m" + std::to_string(level) + ".sdf"), model_file(include(next, "a") + include(next, "b")));
  }
  CHECK_THAT(error_of(world_with(include("m1.sdf")), folder.path()), Contains("the world has more than 5000 models"));
}

TEST_CASE("Links, shapes and frames have a limit", "[hostile]") {
  std::string links, shapes, frames;
  for (int i = 0; i < 5001; ++i) links += "<link name=\"l" + std::to_string(i) + "\"/>\n";
  CHECK(error_of(world_with(model("m", links))) == "w.sdf:5002: the world has more than 5000 links");
  for (int i = 0; i < 20001; ++i) shapes += shape(kBox, i);
  CHECK(error_of(world_with(model("m", link(shapes)))) == "w.sdf:2: the world has more than 20000 shapes");
  for (int i = 0; i < 20001; ++i) frames += "<frame name=\"f" + std::to_string(i) + "\"/>\n";
  CHECK(error_of(world_with(frames)) == "w.sdf:20002: the world has more than 20000 frames and joints");
}

// The first frame is relative to the world.
TEST_CASE("Poses are relative to a chain of at most 100 others, and to no circle", "[hostile]") {
  const auto chain = [](const std::string& attribute, int length) {
    std::string frames = "<frame name=\"f0\"><pose>1 0 0 0 0 0</pose></frame>";
    for (int i = 1; i <= length; ++i) {
      const std::string before = attribute + "=\"f" + std::to_string(i - 1) + "\"";
      frames += "<frame name=\"f" + std::to_string(i) + "\"" +
                (attribute == "attached_to" ? " " + before + "/>\n" : "><pose " + before + "/></frame>\n");
    }
    return error_of(world_with(frames));
  };
  for (const char* attribute : {"relative_to", "attached_to"}) {
    CHECK(chain(attribute, 100) == kLoads);
    CHECK_THAT(chain(attribute, 101), Contains("a pose is relative to a chain of more than 100 others"));
  }
  const std::string circle =
      "<frame name=\"a\"><pose relative_to=\"b\"/></frame><frame name=\"b\"><pose relative_to=\"a\"/></frame>";
  CHECK_THAT(error_of(world_with(circle)), Catch::StartsWith("w.sdf:2: ") && Contains("relative to itself"));
  CHECK_THAT(error_of(world_with(model("m", "<link name=\"l\"><pose relative_to=\"l\"/></link>"))),
             Catch::StartsWith("w.sdf:2: ") && Contains("relative to itself"));
  CHECK_THAT(error_of(world_with("<frame name=\"a\"><pose relative_to=\"nobody\"/></frame>")), Contains("nobody"));
}

TEST_CASE("Elements, attributes and points have a limit before they are read", "[hostile]") {
  std::string elements, attributes, points;
  for (int i = 0; i < 1'000'000; ++i) elements += "<a/>";
  CHECK_THAT(error_of(world_with(elements)), Contains("too many elements and attributes"));
  for (int i = 0; i < 1001; ++i) attributes += " a" + std::to_string(i) + "=\"\"";
  CHECK_THAT(error_of(world_with("<a" + attributes + "/>")), Contains("more than 1000 attributes"));
  for (int i = 0; i < 20000; ++i) points += "<point>0 0</point>";
  CHECK_THAT(error_of(world_with(model("m", link(shape("<polyline>" + points + "</polyline>"))))),
             Catch::StartsWith("w.sdf:2: ") && Contains("at most 500 corners"));
}

TEST_CASE("A model.config has at most 64 KiB", "[hostile]") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "m");
  write_file(folder / "m/model.sdf", model_file(link("")));
  const std::string config = "<model><sdf version=\"1.9\">model.sdf</sdf></model>";
  const auto padded = [&](std::size_t bytes) { return config + std::string(bytes - config.size(), ' '); };
  write_file(folder / "m/model.config", padded(65536));
  CHECK(error_of(world_with(include("m")), folder.path()) == kLoads);
  write_file(folder / "m/model.config", padded(65537));
  CHECK_THAT(error_of(world_with(include("m")), folder.path()),
             Catch::StartsWith("w.sdf:2: ") && Contains("model.config\" is larger than 65536 bytes"));
}

TEST_CASE("All files of a world have 64 MiB together", "[hostile]") {
  const TemporaryFolder folder;
  std::string includes;
  for (int i = 0; i < 5; ++i) {
    const std::string name = "m" + std::to_string(i) + ".sdf";
    write_file(folder / name, model_file("<!--" + std::string((15U << 20U), 'x') + "-->" + link("")));
    includes += include(name, name);
  }
  CHECK_THAT(error_of(world_with(includes), folder.path()),
             Contains("w.sdf:6: ") && Contains("m4.sdf") && Contains("of the 64 MiB of all of a world's files"));
}

TEST_CASE("A mesh that is used a thousand times is read once", "[hostile]") {
  const TemporaryFolder folder;
  write_file(folder / "rock.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n#" + std::string(1U << 20U, 'x'));
  std::string shapes;
  for (int i = 0; i < 1000; ++i) shapes += shape("<mesh><uri>rock.obj</uri></mesh>", i);
  CHECK(error_of(world_with(model("m", link(shapes))), folder.path()) == kLoads);
}

TEST_CASE("After 1000 notes the others are counted", "[hostile]") {
  std::string unknown;
  for (int i = 0; i < 1500; ++i) unknown += "<light name=\"l\"/>\n";
  std::vector<std::string> notes{"of the caller"};
  parse_world(world_with(unknown), "w.sdf", "", notes);
  REQUIRE(notes.size() == 1002);
  CHECK(notes.back() == "500 more notes of this kind are left out");
}

TEST_CASE("Includes that say nothing or nonsense are refused or noted", "[hostile]") {
  const TemporaryFolder folder;
  write_file(folder / "m.sdf", model_file(link("")));
  write_file(folder / "broken.sdf", "<sdf version=\"1.9\"><model");
  write_file(folder / "nameless.sdf", "<sdf version=\"1.9\"><model/></sdf>");
  write_file(folder / "empty.sdf", "");
  for (const std::string& text :
       {std::string("<include/>"), include(""), include(" "), include("broken.sdf"), include("nameless.sdf"),
        include("empty.sdf"), include("."), std::string("<include><uri>m.sdf</uri><pose>1 2 three</pose></include>"),
        std::string("<include><uri>m.sdf</uri><static>perhaps</static></include>"),
        std::string("<include><uri>m.sdf</uri><name>__reserved__</name></include>"),
        std::string("<include><uri>m.sdf</uri><pose relative_to=\"nowhere\"/></include>")}) {
    INFO(text);
    CHECK_THAT(error_of(world_with(text), folder.path()), Catch::StartsWith("w.sdf"));
  }
  for (const std::string& text : {std::string("<include><uri>m.sdf</uri><name/><pose/><static/></include>"),
                                  std::string("<include x=\"1\"><uri>m.sdf</uri><params><a/></params></include>"),
                                  include("model://"), include("file://"), include("x://y")})
    CHECK_NOTHROW(error_of(world_with(text), folder.path()));
}

// 128 x 256 squares, two triangles each: 2^16, so that 2^5 of them are 2^21.
TEST_CASE("A world has at most 2^21 triangles", "[long][hostile]") {
  const TemporaryFolder folder;
  std::string grid, shapes;
  for (int x = 0; x <= 128; ++x)
    for (int y = 0; y <= 256; ++y) grid += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
  for (int x = 0; x < 128; ++x)
    for (int y = 1; y <= 256; ++y) {
      const auto at = [](int corner) { return " " + std::to_string(corner); };
      const int near = 257 * x + y, far = near + 257;
      grid += "f" + at(near) + at(far) + at(far + 1) + "\nf" + at(near) + at(far + 1) + at(near + 1) + "\n";
    }
  write_file(folder / "grid.obj", grid);
  const std::string mesh = "<mesh><uri>grid.obj</uri></mesh>";
  for (int i = 0; i < 32; ++i) shapes += shape(mesh, i);
  CHECK(error_of(world_with(model("m", link(shapes))), folder.path()) == kLoads);
  CHECK_THAT(error_of(world_with(model("m", link(shapes + shape(mesh, 32)))), folder.path()),
             Contains("the world has too many triangles: only 0 are left"));
}

TEST_CASE("A thousand boxes, written or included, take less than 512 MiB", "[long][hostile]") {
  const TemporaryFolder folder;
  write_file(folder / "block.sdf", model_file(link(shape(kBox))));
  std::string written, included;
  for (int i = 0; i < 1000; ++i) {
    const std::string name = "m" + std::to_string(i);
    written += model(name, "<pose>" + std::to_string(i) + " 0 0 0 0 0</pose>" + link(shape(kBox)));
    included += include("block.sdf", name);
  }
  std::vector<std::string> notes;
  CHECK(parse_world(world_with(written), "w.sdf", "", notes).boxes.size() == 1000);
  CHECK(parse_world(world_with(included), "w.sdf", folder.path(), notes).boxes.size() == 1000);
  CHECK(peak_memory_bytes() < (std::size_t{512} << 20U));
}
