#include "physics/files/sdf_schema.hpp"

namespace kenaf::physics {
namespace {

constexpr const char* kName = R"(<attribute name="name" type="string" default="" required="1"/>)";

constexpr const char* kPose = R"(
  <element name="pose" type="pose" default="0 0 0 0 0 0" required="0">
    <attribute name="relative_to" type="string" default="" required="0"/>
    <attribute name="rotation_format" type="string" default="euler_rpy" required="0"/>
    <attribute name="degrees" type="bool" default="false" required="0"/>
  </element>)";

constexpr const char* kGravity = R"(<element name="gravity" type="vector3" default="0 0 -9.8" required="1"/>)";

// An <include> may give a model no name.
constexpr const char* kModel = R"(
    <attribute name="name" type="string" default="" required="0"/>
    <attribute name="canonical_link" type="string" default="" required="0"/>
    <attribute name="placement_frame" type="string" default="" required="0"/>
    <element name="static" type="bool" default="false" required="0"/>)";

constexpr const char* kAttachedTo = R"(<attribute name="attached_to" type="string" default="" required="0"/>)";

constexpr const char* kInertial = R"(
    <element name="inertial" required="0">
      <attribute name="auto" type="bool" default="false" required="0"/>
      <element name="mass" type="double" default="1" required="0"/>
      <element name="density" type="double" default="1000" required="0"/>
    </element>)";

constexpr const char* kShape = R"(
    <element name="density" type="double" default="1000" required="0"/>
    <element name="geometry" required="1">
      <element name="plane" required="0">
        <element name="normal" type="vector3" default="0 0 1" required="1"/>
        <element name="size" type="vector2d" default="1 1" required="1"/>
      </element>
      <element name="box" required="0">
        <element name="size" type="vector3" default="1 1 1" required="1"/>
      </element>
      <element name="cylinder" required="0">
        <element name="radius" type="double" default="1" required="1"/>
        <element name="length" type="double" default="1" required="1"/>
      </element>
      <element name="sphere" required="0">
        <element name="radius" type="double" default="1" required="1"/>
      </element>
      <element name="capsule" required="0">
        <element name="radius" type="double" default="0.5" required="1"/>
        <element name="length" type="double" default="1" required="1"/>
      </element>
      <element name="ellipsoid" required="0">
        <element name="radii" type="vector3" default="1 1 1" required="1"/>
      </element>
      <element name="polyline" required="0">
        <element name="point" type="vector2d" default="0 0" required="+"/>
        <element name="height" type="double" default="1" required="1"/>
      </element>
      <element name="mesh" required="0">
        <element name="uri" type="string" default="__default__" required="1"/>
        <element name="scale" type="vector3" default="1 1 1" required="0"/>
        <element name="submesh" required="0">
          <element name="name" type="string" default="__default__" required="1"/>
          <element name="center" type="bool" default="false" required="0"/>
        </element>
      </element>
      <element name="heightmap" required="0">
        <element name="uri" type="string" default="__default__" required="1"/>
        <element name="size" type="vector3" default="1 1 1" required="0"/>
        <element name="pos" type="vector3" default="0 0 0" required="0"/>
      </element>
    </element>
    <element name="surface" required="0">
      <element name="friction" required="0">
        <element name="ode" required="0">
          <element name="mu" type="double" default="1" required="0"/>
        </element>
      </element>
    </element>)";

std::string inside_of(std::string_view kind) {
  const std::string name = kName, pose = kPose;
  if (kind == "model") return kModel + pose;
  if (kind == "link") return name + pose + kInertial;
  if (kind == "frame") return name + kAttachedTo + pose;
  return name + pose + kShape;  // "collision"
}

}  // namespace

std::string schema_of(std::string_view kind) {
  std::string in_world = kName;
  if (kind == "world")
    in_world += kGravity;
  else
    in_world += "<element name=\"" + std::string(kind) + "\" required=\"*\">" + inside_of(kind) + "</element>";
  return R"(<element name="sdf" required="1"><attribute name="version" type="string" default="1.9" required="1"/>)"
         R"(<element name="world" required="*">)" +
         in_world + "</element></element>";
}

}  // namespace kenaf::physics
