// A small URDF that is right, to be made wrong in one place.
#pragma once

#include <stdexcept>
#include <string>

namespace kenaf::test {

// Two wheels of radius 0.1 m at y = +-0.2 m, a ball behind, a hull of 0.4 x 0.3 x 0.1 m around base_link. 4 + 2 x 0.5
// kg.
inline const std::string kSmallUrdf = R"(<?xml version="1.0"?>
<robot name="small">
  <link name="base_link">
    <inertial><mass value="4"/><inertia ixx="0.04" ixy="0" ixz="0" iyy="0.06" iyz="0" izz="0.08"/></inertial>
    <collision><geometry><box size="0.4 0.3 0.1"/></geometry></collision>
  </link>
  <link name="left_wheel">
    <inertial><mass value="0.5"/><inertia ixx="0.0014" ixy="0" ixz="0" iyy="0.0025" iyz="0" izz="0.0014"/></inertial>
    <collision><origin rpy="1.5707963267948966 0 0"/><geometry><cylinder radius="0.1" length="0.04"/></geometry></collision>
  </link>
  <joint name="left_axle" type="continuous">
    <parent link="base_link"/><child link="left_wheel"/><origin xyz="0.1 0.2 0"/><axis xyz="0 1 0"/>
    <limit effort="2" velocity="5"/>
  </joint>
  <link name="right_wheel">
    <inertial><mass value="0.5"/><inertia ixx="0.0014" ixy="0" ixz="0" iyy="0.0025" iyz="0" izz="0.0014"/></inertial>
    <collision><origin rpy="1.5707963267948966 0 0"/><geometry><cylinder radius="0.1" length="0.04"/></geometry></collision>
  </link>
  <joint name="right_axle" type="continuous">
    <parent link="base_link"/><child link="right_wheel"/><origin xyz="0.1 -0.2 0"/><axis xyz="0 1 0"/>
    <limit effort="2" velocity="5"/>
  </joint>
  <link name="ball">
    <collision><geometry><sphere radius="0.03"/></geometry></collision>
  </link>
  <joint name="ball_joint" type="fixed">
    <parent link="base_link"/><child link="ball"/><origin xyz="-0.15 0 -0.07"/>
  </joint>
</robot>
)";

// The text with the first `from` after `after` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to,
                            const std::string& after = "") {
  const std::size_t at = text.find(from, text.find(after));
  if (at == std::string::npos) throw std::logic_error("no \"" + from + "\"");
  return text.replace(at, from.size(), to);
}

inline std::string with(const std::string& elements) {
  return replaced(kSmallUrdf, "</robot>", elements + "</robot>");
}

}  // namespace kenaf::test
