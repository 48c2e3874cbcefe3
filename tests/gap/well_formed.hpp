// Whether any reader can take a page: the reports are well-formed XML, too.
#pragma once

#include <expat.h>

#include <memory>
#include <string>
#include <string_view>

#include "physics/xml_line.hpp"

namespace kenaf::test {

// What is wrong with it, with its line; empty: nothing.
inline std::string fault_of_xml(std::string_view text) {
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate("UTF-8"), &XML_ParserFree);
  if (XML_Parse(parser.get(), text.data(), static_cast<int>(text.size()), 1) == XML_STATUS_OK) return {};
  return "line " + std::to_string(physics::line_of(parser.get())) + ": " +
         XML_ErrorString(XML_GetErrorCode(parser.get()));
}

}  // namespace kenaf::test
