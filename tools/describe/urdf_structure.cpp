#include "tools/describe/urdf_structure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace kenaf::describe {
namespace {

using description::DescriptionError;

constexpr std::size_t kMostLinks = 1000;
constexpr std::size_t kMostNameBytes = 200;
constexpr double kLargestNumber = 1e9;

struct JointEnds {
  std::string joint, parent;
  std::size_t line;
};

[[noreturn]] void structure_fault(const std::string& file, std::size_t line, const std::string& what) {
  throw DescriptionError(fmt::format("{}:{}: {}", file, line, what));
}

const std::string& name_of(const XmlNode& node, const std::string& file) {
  const std::string* const name = node.attribute("name");
  if (!name || name->empty()) structure_fault(file, node.line, fmt::format("a <{}> has no name", node.name));
  if (name->size() > kMostNameBytes)
    structure_fault(file, node.line, fmt::format("a {}'s name is longer than {} bytes", node.name, kMostNameBytes));
  return *name;
}

// How many numbers an attribute of a link's or joint's parts has; 0: it is no number, or none that is read.
std::size_t numbers_of(const std::string& element, const std::string& attribute) {
  if (attribute == "xyz" || attribute == "rpy" || attribute == "size" || attribute == "scale") return 3;
  if (element == "mass" && attribute == "value") return 1;
  if (element == "inertia") return 1;
  if (element == "cylinder" || element == "sphere") return attribute == "radius" || attribute == "length" ? 1 : 0;
  return element == "limit" ? 1 : 0;
}

void check_numbers(const XmlNode& node, const std::string& owner, const std::string& file) {
  for (const auto& [attribute, text] : node.attributes) {
    const std::size_t count = numbers_of(node.name, attribute);
    if (count == 0) continue;
    const auto numbers = numbers_in(text);
    if (!numbers || numbers->size() != count)
      structure_fault(file, node.line,
                      fmt::format("{}: <{}> has {}=\"{}\", but it takes {} finite number{}", owner, node.name,
                                  attribute, text, count, count == 1 ? "" : "s, separated by blanks"));
    // Gazebo's models write huge limits for "none"
    if (node.name != "limit" && std::ranges::any_of(*numbers, [](double x) { return std::abs(x) > kLargestNumber; }))
      structure_fault(file, node.line,
                      fmt::format("{}: <{}> has {}=\"{}\": units are metres, radians, kilograms", owner, node.name,
                                  attribute, text));
  }
  for (const XmlNode& child : node.children)
    if (node.name != "link" || child.name != "sensor") check_numbers(child, owner, file);
}

std::string end_of(const XmlNode& joint, const char* end, const std::map<std::string, std::size_t>& links,
                   const std::string& file) {
  const std::string& name = *joint.attribute("name");
  const XmlNode* const node = joint.child(end);
  const std::string* const link = node ? node->attribute("link") : nullptr;
  if (!link) structure_fault(file, joint.line, fmt::format("joint \"{}\" has no <{} link=\"...\">", name, end));
  if (!links.contains(*link))
    structure_fault(
        file, node->line,
        fmt::format("joint \"{}\": its {} \"{}\" is no link of this file; add <link name=\"{}\"/>, or remove "
                    "the joint",
                    name, end, *link, *link));
  return *link;
}

std::map<std::string, std::size_t> links_of(const XmlNode& robot, const std::string& file) {
  std::map<std::string, std::size_t> lines;
  for (const XmlNode& node : robot.children) {
    if (node.name != "link") continue;
    const auto [first, fresh] = lines.emplace(name_of(node, file), node.line);
    if (!fresh)
      structure_fault(file, node.line, fmt::format("link \"{}\" was already on line {}", first->first, first->second));
    check_numbers(node, fmt::format("link \"{}\"", first->first), file);
  }
  if (lines.empty()) structure_fault(file, robot.line, "the robot has no link");
  if (lines.size() > kMostLinks)
    structure_fault(file, robot.line, fmt::format("the robot has {} links, of at most {}", lines.size(), kMostLinks));
  return lines;
}

// Parents by child.
std::map<std::string, JointEnds> joints_of(const XmlNode& robot, const std::map<std::string, std::size_t>& links,
                                           const std::string& file) {
  std::map<std::string, JointEnds> parents;
  std::map<std::string, std::size_t> lines;
  for (const XmlNode& node : robot.children) {
    if (node.name != "joint") continue;
    const std::string& name = name_of(node, file);
    const auto [first, fresh] = lines.emplace(name, node.line);
    if (!fresh)
      structure_fault(file, node.line, fmt::format("joint \"{}\" was already on line {}", name, first->second));
    check_numbers(node, fmt::format("joint \"{}\"", name), file);
    const std::string parent = end_of(node, "parent", links, file), child = end_of(node, "child", links, file);
    const auto [other, only] = parents.emplace(child, JointEnds{name, parent, node.line});
    if (!only)
      structure_fault(
          file, node.line,
          fmt::format("joints \"{}\" and \"{}\" both lead to link \"{}\": links form a tree, so a closed loop "
                      "is opened at one of them",
                      other->second.joint, name, child));
  }
  return parents;
}

}  // namespace

void check_structure(const XmlNode& robot, const std::string& file) {
  // The document, its links and its joints, each alone.
  if (robot.name != "robot")
    structure_fault(file, robot.line, fmt::format("is no URDF: its root is <{}>, not <robot>", robot.name));
  for (const XmlNode& node : robot.children)
    if (node.name.starts_with("xacro:"))
      structure_fault(file, node.line,
                      fmt::format("<{}>: this is xacro; run `xacro FILE > robot.urdf` first", node.name));
  const std::map<std::string, std::size_t> links = links_of(robot, file);
  const std::map<std::string, JointEnds> parents = joints_of(robot, links, file);

  // A way up from each link, no longer than there are links, ends at the only root.
  std::vector<std::string> roots;
  for (const auto& [link, line] : links)
    if (!parents.contains(link)) roots.push_back(link);
  for (const auto& [link, line] : links) {
    std::size_t steps = 0;
    for (auto up = parents.find(link); up != parents.end(); up = parents.find(up->second.parent))
      if (++steps > links.size())
        structure_fault(
            file, up->second.line,
            fmt::format("joint \"{}\" is in a loop of joints: links form a tree; remove one of the loop's joints",
                        up->second.joint));
  }
  if (roots.size() > 1)
    structure_fault(file, links.at(roots[1]),
                    fmt::format("links without a parent: \"{}\"; a robot has one root, so connect the others by joints",
                                fmt::join(roots, "\", \"")));
}

}  // namespace kenaf::describe
