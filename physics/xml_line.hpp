// The line that an XML parser is at, with either version of Expat: 2.9 counts in 64 bits, and calls the function that
// it had before obsolete.
#pragma once

#include <expat.h>

#include <cstdint>

namespace kenaf::physics {

inline std::uint64_t line_of(XML_Parser parser) {
#if XML_MAJOR_VERSION > 2 || XML_MINOR_VERSION >= 9
  return XML_GetCurrentLineNumber64(parser);
#else
  return XML_GetCurrentLineNumber(parser);
#endif
}

}  // namespace kenaf::physics
