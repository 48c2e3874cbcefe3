// The names of object dictionary entries: CiA 301, 7.5.2; CiA 402-2; CiA 410.
#pragma once

#include <string>

#include "can/canopen/object.hpp"

namespace kenaf::canlog {

// "statusword", "TPDO1 mapping, entry 2"; empty: manufacturer-specific, or of a profile that this robot's nodes do not
// have.
std::string object_name(canopen::ObjectAddress object);

// "0x6041:00 (statusword)", without brackets if it has no name.
std::string object_words(canopen::ObjectAddress object);

}  // namespace kenaf::canlog
