// A small XML document as a tree, read by Expat within limits.
//
// Thread safety: values and pure functions.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/description/description_error.hpp"

namespace kenaf::describe {

struct XmlNode {
  std::string name;
  std::map<std::string, std::string> attributes;
  std::string text;  // all of its own, joined
  std::vector<XmlNode> children;
  std::size_t line = 0;

  const std::string* attribute(const std::string& key) const;  // nullptr: none of that name
  const XmlNode* child(std::string_view child_name) const;     // the first one, or nullptr
  const XmlNode* below(std::string_view path) const;           // "ray/range/min"; nullptr if one is missing
};

// Returns the document's root. Throws DescriptionError with `file` and line if the text is not well-formed XML, is
// larger than 8 MiB, nests elements more than 50 deep, has more than 100000 elements or 100 attributes in one, has a
// document type (so no entities of its own), or has another encoding than UTF-8.
XmlNode parse_xml(std::string_view text, const std::string& file);

// Returns the numbers of a text that are separated by blanks; nullopt if something in it is no finite number.
std::optional<std::vector<double>> numbers_in(std::string_view text);

// Returns the text with &, <, >, quotes and control characters escaped or replaced, for an attribute or an element.
std::string xml_escaped(std::string_view text);

}  // namespace kenaf::describe
