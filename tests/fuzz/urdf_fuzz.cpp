// Any text is a URDF of which a description is made that loads, or is refused with a DescriptionError. Of that
// description a URDF is made, which is well-formed.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "physics/robot_description.hpp"
#include "tools/describe/from_urdf.hpp"
#include "tools/describe/to_urdf.hpp"
#include "tools/describe/xml_tree.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf;
  physics::RobotDescription robot;
  try {
    // no folder: no file that the text names is opened
    const auto made = describe::from_urdf({reinterpret_cast<const char*>(data), size}, "fuzz.urdf", {});
    robot = physics::parse_robot(made.toml, "fuzz.toml");
  } catch (const description::DescriptionError&) {
    return 0;
  }
  const std::string xml = describe::to_urdf(robot).xml;
  describe::parse_xml(xml, "again.urdf");
  try {
    describe::from_urdf(xml, "again.urdf", {});
  } catch (const description::DescriptionError&) {  // what is larger than a URDF's numbers may be
  }
  return 0;
}
