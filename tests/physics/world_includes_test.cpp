// Models that a world includes from files: where they are found, and what the <include> says in place of the model. The
// places are derived by hand from the specification, http://sdformat.org/tutorials?tut=composition.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>

#include "physics/world_description.hpp"
#include "tests/formats/runs/temporary_folder.hpp"

using namespace kenaf::physics;
using Catch::Contains;
using kenaf::test::TemporaryFolder;
using kenaf::test::write_file;
namespace fs = std::filesystem;

namespace {

constexpr const char* kQuarterTurn = "1.5707963267948966";

std::string world_with(const std::string& inside) {
  return "<sdf version=\"1.9\"><world name=\"w\">\n" + inside + "\n</world></sdf>";
}

std::string include(const std::string& uri, const std::string& more = "") {
  return "<include><uri>" + uri + "</uri>" + more + "</include>\n";
}

std::string box_link(double size_m = 1) {
  const std::string size = std::to_string(size_m);
  return "<link name=\"l\"><collision name=\"c\"><geometry><box><size>" + size + " " + size + " " + size +
         "</size></box></geometry></collision></link>";
}

std::string model_file(const std::string& inside, const std::string& version = "1.9", const std::string& name = "m") {
  return "<sdf version=\"" + version + "\"><model name=\"" + name + "\">" + inside + "</model></sdf>";
}

const std::string kStatic = "<static>true</static>";

// A folder with block/model.sdf: a static box whose own place is (9, 9, 9).
struct Folder : TemporaryFolder {
  Folder() { add("block/model.sdf", model_file(kStatic + "<pose>9 9 9 0 0 0</pose>" + box_link())); }

  void add(const std::string& name, const std::string& text) const {
    fs::create_directories((*this / name).parent_path());
    write_file(*this / name, text);
  }
};

struct Loaded {
  WorldDescription world;
  std::vector<std::string> notes;

  Eigen::Vector3d place(std::size_t i = 0) const { return world.boxes.at(i).X_WBox.p; }
};

Loaded load(const Folder& folder, const std::string& inside, const std::vector<fs::path>& search = {}) {
  Loaded loaded;
  loaded.world = parse_world(world_with(inside), "w.sdf", folder.path(), loaded.notes, search);
  return loaded;
}

std::string error_of(const Folder& folder, const std::string& inside) {
  try {
    load(folder, inside);
  } catch (const kenaf::description::DescriptionError& error) {
    return error.what();
  }
  return "";
}

bool is_at(const Eigen::Vector3d& place, double x, double y, double z) {
  return (place - Eigen::Vector3d(x, y, z)).norm() < 1e-9;
}

}  // namespace

TEST_CASE("A model is found by its folder, its file, and by all ways to name them") {
  const Folder folder;
  for (const std::string& uri :
       {std::string("model://block"), std::string("block"), std::string("block/model.sdf"),
        std::string("model://block/model.sdf"), std::string("file://block/model.sdf"), std::string("./block/../block"),
        (folder / "block").string(), "file://" + (folder / "block/model.sdf").string()}) {
    INFO(uri);
    const Loaded loaded = load(folder, include(uri));
    CHECK(is_at(loaded.place(), 9, 9, 9));
    CHECK(loaded.world.boxes[0].name == "m");
    CHECK(loaded.notes.empty());
  }
}

TEST_CASE("An include says name, pose and static in place of the model") {
  const Folder folder;
  folder.add("loose/model.sdf", model_file("<pose>9 9 9 0 0 0</pose>" + box_link()));
  const Loaded loaded =
      load(folder, include("model://loose", "<name>crate</name><pose>1 2 3 0 0 0</pose><static>true</static>") +
                       include("model://loose", "<name>empty pose</name><pose/>") +
                       include("model://block", "<static>false</static>"));
  REQUIRE(loaded.world.boxes.size() == 3);
  CHECK(loaded.world.boxes[0].name == "crate");
  CHECK(is_at(loaded.place(0), 1, 2, 3));
  CHECK(loaded.world.boxes[0].mass_kg == 0);
  CHECK(is_at(loaded.place(1), 0, 0, 0));
  CHECK(loaded.world.boxes[1].mass_kg == 1);
  CHECK(is_at(loaded.place(2), 9, 9, 9));
  CHECK(loaded.world.boxes[2].mass_kg == 1);
}

TEST_CASE("The same model is included under many names, and not twice under one") {
  const Folder folder;
  const Loaded loaded = load(folder, include("block", "<name>a</name><pose>1 0 0 0 0 0</pose>") +
                                         include("block", "<name>b</name><pose>2 0 0 0 0 0</pose>"));
  CHECK(is_at(loaded.place(0), 1, 0, 0));
  CHECK(is_at(loaded.place(1), 2, 0, 0));
  CHECK_THAT(error_of(folder, include("block") + include("block")),
             Contains("w.sdf") && Contains("has the name \"m\""));
}

// The frame "top" is 0.5 above the model's origin and turned with it: where it is put, the origin is 0.5 below.
TEST_CASE("A placement frame is put at the pose, with the model around it") {
  const Folder folder;
  folder.add("table/model.sdf",
             model_file(kStatic + "<frame name=\"top\"><pose>0.25 0 0.5 0 0 0</pose></frame>" + box_link()));
  const Loaded loaded = load(folder, include("table", std::string("<pose>1 2 3 0 0 ") + kQuarterTurn +
                                                          "</pose><placement_frame>top</placement_frame>"));
  CHECK(is_at(loaded.place(), 1, 2 - 0.25, 2.5));
  CHECK_THAT(error_of(folder, include("table", "<placement_frame>top</placement_frame>")), Contains("needs a <pose>"));
  CHECK_THAT(error_of(folder, include("table", "<pose/><placement_frame>bottom</placement_frame>")),
             Contains("w.sdf") && Contains("bottom"));
}

TEST_CASE("An include's pose may be relative to another model or frame") {
  const Folder folder;
  const std::string turned = std::string("1 0 0 0 0 ") + kQuarterTurn;
  const Loaded loaded =
      load(folder, "<frame name=\"f\"><pose>" + turned + "</pose></frame>" +
                       include("block", "<name>a</name><pose relative_to=\"f\">2 0 0 0 0 0</pose>") +
                       include("block", "<name>b</name><pose relative_to=\"a\" degrees=\"true\">0 0 1 0 0 90</pose>"));
  CHECK(is_at(loaded.place(0), 1, 2, 0));  // 2 along the frame's x, the world's y
  CHECK(is_at(loaded.place(1), 1, 2, 1));
}

// Each level turns by 90 degrees and goes 1 ahead: (1, 0), then 1 along y, then 1 along -x.
TEST_CASE("Includes in includes stand where the outer ones put them, and are static with them") {
  const Folder folder;
  const std::string pose = std::string("<pose>1 0 0 0 0 ") + kQuarterTurn + "</pose>";
  folder.add("inner/model.sdf", model_file(box_link()));
  folder.add("middle/model.sdf", model_file(include("model://inner", pose), "1.9", "middle"));
  folder.add("outer/model.sdf", model_file(kStatic + include("model://middle", pose), "1.9", "outer"));
  const Loaded loaded = load(folder, include("model://outer", pose));
  REQUIRE(loaded.world.boxes.size() == 1);
  CHECK(is_at(loaded.place(), 0, 1, 0));
  CHECK(loaded.world.boxes[0].name == "outer/middle/m");
  CHECK(loaded.world.boxes[0].mass_kg == 0);
}

TEST_CASE(
    "A relative path starts in the folder of the file that says it, then in the world's, then in the search path") {
  const Folder folder;
  const TemporaryFolder elsewhere;
  fs::create_directories(elsewhere / "far");
  write_file(elsewhere / "far/model.sdf", model_file(kStatic + box_link(3)));
  folder.add("a/part.sdf", model_file(kStatic + box_link(1)));
  folder.add("part.sdf", model_file(kStatic + box_link(2)));
  folder.add("a/model.sdf", model_file(kStatic + include("part.sdf"), "1.9", "a"));
  folder.add("b/model.sdf", model_file(kStatic + include("part.sdf"), "1.9", "b"));
  folder.add("c/model.sdf", model_file(kStatic + include("far"), "1.9", "c"));
  const Loaded loaded = load(folder, include("a") + include("b") + include("c"), {elsewhere.path()});
  REQUIRE(loaded.world.boxes.size() == 3);
  for (int i = 0; i < 3; ++i) CHECK(loaded.world.boxes[static_cast<std::size_t>(i)].size_m.x() == i + 1);
}

TEST_CASE("An included model has its own meshes and height maps") {
  const Folder folder;
  folder.add("rock/meshes/rock.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const std::string uri : {"meshes/rock.obj", "model://rock/meshes/rock.obj", "file://meshes/rock.obj"}) {
    folder.add("rock/model.sdf", model_file(kStatic + "<link name=\"l\"><collision name=\"c\"><geometry><mesh><uri>" +
                                            uri + "</uri></mesh></geometry></collision></link>"));
    const Loaded loaded = load(folder, include("rock", "<pose>0 0 4 0 0 0</pose>"));
    REQUIRE(loaded.world.meshes.size() == 1);
    CHECK(loaded.world.meshes[0].vertices_W[0].z() == 4);
  }
  folder.add("rock/model.sdf",
             "<sdf version=\"1.9\"><model name=\"m\">\n<static>true</static><link name=\"l\"><collision "
             "name=\"c\"><geometry>\n<mesh><uri>gone.obj</uri></mesh></geometry></collision></link>"
             "</model></sdf>");
  CHECK_THAT(error_of(folder, include("rock")), Contains("rock/model.sdf:3: \"gone.obj\": there is no such file"));
}

TEST_CASE("A model.config says which file is the model: the newest SDF up to 1.9") {
  const Folder folder;
  for (const char* version : {"1.4", "1.6", "1.12"})
    folder.add(std::string("many/") + version + ".sdf", model_file(kStatic + box_link(), version, version));
  const auto config = [](const std::string& files) { return "<?xml version=\"1.0\"?><model>" + files + "</model>"; };
  folder.add("many/model.config",
             config("<name>x</name><sdf version=\"1.12\">1.12.sdf</sdf><sdf version=\"1.6\">1.6.sdf</sdf>"
                    "<sdf version=\"1.4\">1.4.sdf</sdf>"));
  CHECK(load(folder, include("many")).world.boxes.at(0).name == "1.6");
  folder.add("many/model.config", config("<sdf version=\"1.12\">1.12.sdf</sdf>"));
  CHECK(load(folder, include("many")).world.boxes.at(0).name == "1.12");
  folder.add("many/model.config", config(""));
  CHECK_THAT(error_of(folder, include("many")), Contains("w.sdf:2: ") && Contains("names no model"));
  folder.add("many/model.config", config("<sdf>gone.sdf</sdf>"));
  CHECK_THAT(error_of(folder, include("many")), Contains("holds no gone.sdf"));
}

TEST_CASE("A model of an older SDF is included as its own version says") {
  const Folder folder;
  folder.add("old/model.sdf",
             model_file(kStatic + "<frame name=\"f\"><pose>0 0 1 0 0 0</pose></frame><link name=\"l\"><pose "
                                  "frame=\"f\">1 0 0 0 0 0</pose><collision name=\"c\"><geometry><box>"
                                  "<size>1 1 1</size></box></geometry></collision></link>",
                        "1.6"));
  CHECK(is_at(load(folder, include("old", "<pose>0 5 0 0 0 0</pose>")).place(), 1, 5, 1));
}

// As Gazebo, which goes on without what it does not find.
TEST_CASE("An include that is not here is left out, and said so with its line") {
  const Folder folder;
  folder.add("sun/model.sdf", "<sdf version=\"1.9\"><light name=\"sun\" type=\"directional\"/></sdf>");
  const Loaded loaded = load(folder, include("model://gone") + include("https://example.org/models/rock") +
                                         include("model://sun") + include("block"));
  CHECK(loaded.world.boxes.size() == 1);
  REQUIRE(loaded.notes.size() == 3);
  CHECK_THAT(loaded.notes[0], Catch::StartsWith("w.sdf:2: <include> of \"model://gone\" is left out") &&
                                  Contains(folder.path().string()) && Contains("KENAF_WORLD_PATH"));
  CHECK_THAT(loaded.notes[1], Catch::StartsWith("w.sdf:3: <include> of \"https://example.org/models/rock\""));
  CHECK_THAT(loaded.notes[2], Contains("w.sdf:4: ") && Contains("holds no <model>"));
}

TEST_CASE("What an included file does not simulate is noted once, with its own line") {
  const Folder folder;
  folder.add("lamp/model.sdf",
             "<sdf version=\"1.9\"><model name=\"lamp\">\n<static>1</static>\n<link "
             "name=\"l\"><light name=\"x\" type=\"spot\"/></link></model></sdf>");
  std::string inside;
  for (const char* name : {"a", "b", "c"}) inside += include("lamp", std::string("<name>") + name + "</name>");
  const Loaded loaded = load(folder, inside);
  REQUIRE(loaded.notes.size() == 1);
  CHECK_THAT(loaded.notes[0], Contains("lamp/model.sdf:3: <light> in <link> is not simulated"));
}

namespace {

std::string merged(const std::string& uri, const std::string& more = "") {
  return "<include merge=\"true\"><uri>" + uri + "</uri>" + more + "</include>\n";
}

}  // namespace

// The model stands at (1, 0, 0), turned by 90 degrees: what is 1 ahead in it is at (1, 1, 0) outside.
TEST_CASE("What is in a merged model is part of the model that includes it") {
  const Folder folder;
  folder.add("part/model.sdf", model_file(kStatic +
                                          "<frame name=\"ahead\"><pose>1 0 0 0 0 0</pose></frame>"
                                          "<frame name=\"up\" attached_to=\"ahead\"><pose>0 0 1 0 0 0</pose></frame>"
                                          "<frame name=\"own\" attached_to=\"__model__\"/>" +
                                          box_link(1)));
  const std::string turned = std::string("<pose>1 0 0 0 0 ") + kQuarterTurn + "</pose>";
  const auto second = [&](const std::string& relative_to) {
    folder.add(
        "outer/model.sdf",
        model_file(kStatic + merged("part", turned) + "<link name=\"second\"><pose relative_to=\"" + relative_to +
                       "\"/><collision name=\"c\"><geometry><box><size>2 2 2</size></box></geometry>"
                       "</collision></link>",
                   "1.9", "outer"));
    return load(folder, include("outer"));
  };
  const Loaded loaded = second("ahead");
  REQUIRE(loaded.world.boxes.size() == 2);
  CHECK(loaded.notes.empty());
  CHECK(is_at(loaded.place(0), 1, 0, 0));
  CHECK(is_at(loaded.place(1), 1, 1, 0));
  CHECK(is_at(second("up").place(1), 1, 1, 1));
  CHECK(is_at(second("own").place(1), 1, 0, 0));
  CHECK(is_at(second("_merged__m__model__").place(1), 1, 0, 0));
}

TEST_CASE("The parts of a merged model are static if the one around them is, and have no name twice") {
  const Folder folder;
  folder.add("loose/model.sdf", model_file(merged("block"), "1.9", "outer"));
  CHECK(load(folder, include("loose")).world.boxes.at(0).mass_kg == 1);
  folder.add("twice/model.sdf", model_file(kStatic + box_link() + merged("block"), "1.9", "outer"));
  CHECK_THAT(error_of(folder, include("twice")), Contains("has the name \"l\""));
}

TEST_CASE("A model that cannot be merged keeps its own frames, and is said so") {
  const Folder folder;
  folder.add("top/model.sdf",
             model_file(kStatic + "<frame name=\"top\"><pose>0 0 1 0 0 0</pose></frame>" + box_link()));
  folder.add("outer/model.sdf",
             model_file(kStatic + merged("top", "<pose>1 0 0 0 0 0</pose><placement_frame>top</placement_frame>"),
                        "1.9", "outer"));
  for (const std::string& inside : {include("outer"), merged("block")}) {
    const Loaded loaded = load(folder, inside);
    CHECK(loaded.world.boxes.size() == 1);
    REQUIRE(loaded.notes.size() == 1);
    CHECK_THAT(loaded.notes[0], Contains("merge is simulated only in"));
  }
}

// 2 lanes of 3 pallets of 10 x 10 posts; post_3_4 stands out by 0.01 * ((3 * 3 + 5 * 4) % 7) m = 0.01 m, its centre
// 0.05 m below its top; the lane is at (1, 0.6), the pallet at (0, -0.45) in it.
TEST_CASE("The example of docs/worlds.md makes the world that it says") {
  const std::string page = kenaf::test::read_file(KENAF_SOURCE_DIR "/docs/worlds.md");
  const std::size_t from = page.find("mkdir -p arena/"), to = page.find("kenaf-gap simulate --world ./arena/arena.sdf");
  REQUIRE(from < to);
  REQUIRE(to != std::string::npos);
  const TemporaryFolder folder;
  write_file(folder / "make.sh", page.substr(from, to - from));
  REQUIRE(std::system(("cd '" + folder.path().string() + "' && bash -e make.sh").c_str()) == 0);
  std::vector<std::string> notes;
  const WorldDescription world = load_world((folder / "arena/arena.sdf").string(), notes);
  CHECK(notes.empty());
  CHECK(world.boxes.size() == 600);
  const auto post = std::ranges::find(world.boxes, "left/pallet_0/post_3_4", &Box::name);
  REQUIRE(post != world.boxes.end());
  CHECK(is_at(post->X_WBox.p, 1.3, 0.6 - 0.45 + 0.4, -0.04));
}

TEST_CASE("KENAF_WORLD_PATH names folders, separated by colons") {
  ::unsetenv("KENAF_WORLD_PATH");
  CHECK(world_search_path().empty());
  ::setenv("KENAF_WORLD_PATH", "/a:relative/b::/c:", 1);
  CHECK(world_search_path() == std::vector<fs::path>{"/a", "relative/b", "/c"});

  // A world file finds its models there.
  const Folder folder;
  const TemporaryFolder worlds;
  write_file(worlds / "w.sdf", world_with(include("model://block")));
  ::setenv("KENAF_WORLD_PATH", folder.path().c_str(), 1);
  std::vector<std::string> notes;
  CHECK(load_world((worlds / "w.sdf").string(), notes).boxes.size() == 1);
  ::unsetenv("KENAF_WORLD_PATH");
  CHECK(load_world((worlds / "w.sdf").string(), notes).boxes.empty());
}
