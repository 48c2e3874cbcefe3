// What the attributes of an SVG text hold.
//
// Without std::regex: a program that has it at -O0 lends it to every library that uses it, and those that read worlds
// do so whenever a process starts. 0.12 s for each test case.
#pragma once

#include <string>
#include <vector>

namespace kenaf::test {

// The values of all attributes of this name, in their order; `svg` is well formed.
inline std::vector<std::string> attributes(const std::string& svg, const std::string& name) {
  const std::string begin = " " + name + "=\"";
  std::vector<std::string> values;
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at)) {
    at += begin.size();
    values.push_back(svg.substr(at, svg.find('"', at) - at));
  }
  return values;
}

}  // namespace kenaf::test
