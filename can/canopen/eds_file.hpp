// A device's electronic data sheet (EDS) or its configured form (DCF): the objects of its dictionary. CiA 306-1.
//
//   [DeviceInfo]              [1018]                    [1018sub1]
//   VendorName=...            ParameterName=Identity    ParameterName=Vendor
//   ProductName=...           ObjectType=0x9            ObjectType=0x7
//                             SubNumber=5               DataType=0x0007
//                                                       AccessType=ro
//                                                       DefaultValue=$NODEID+0x180
//
// Sections and keys in any case and order. Also read: CompactSubObj (one section for all sub-indices, with [1003Name]
// and [1003Value]), CompactPDO (PDO records without sections of their own), and in a DCF ParameterValue, which stands
// before DefaultValue. Makers' files are often not quite right: what cannot be understood is listed with its line, and
// the rest is read.
//
// Thread safety: values and pure functions.
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "can/canopen/eds_number.hpp"
#include "can/canopen/object.hpp"

namespace kenaf::canopen {

// What a master may do with an object. "rwr" and "rww" are both read_write; "const" is read_only.
enum class EdsAccess : std::uint8_t { read_only, write_only, read_write };
std::string_view describe(EdsAccess access);  // "read only"

// Data types of CiA 301, 7.4.7, by number; others have no bits here.
struct EdsType {
  std::uint16_t number = 0;  // 0: the file gives none
  // 8 to 64 for whole numbers and truth values; 0 for texts, domains, real numbers, and others.
  unsigned bits() const;
  bool is_signed() const;
};
std::string describe(EdsType type);  // "UNSIGNED32", "data type 0x000f"

struct EdsObject {
  int line = 0;  // of its section
  std::string name;
  EdsType type;
  EdsAccess access = EdsAccess::read_only;
  bool mappable = false;  // PDOMapping
  std::optional<EdsNumber> low{}, high{},
      value{};  // LowLimit, HighLimit; ParameterValue or DefaultValue; whole numbers only
};

struct EdsFault {
  int line;  // 0: the file as a whole
  std::string words;
};

struct EdsFile {
  std::string vendor, product;                 // of [DeviceInfo]; may be empty
  std::map<ObjectAddress, EdsObject> objects;  // those that hold a value; a record is in its sub-indices
  int receive_pdos = 0, transmit_pdos = 0;     // NrOfRXPDO, NrOfTXPDO
  std::optional<NodeId> node;                  // of a DCF's [DeviceCommissioning]
  std::vector<EdsFault> faults;                // by line; at most kMostEdsFaults

  const EdsObject* find(ObjectAddress object) const;
  bool has_index(std::uint16_t index) const;
};

inline constexpr std::size_t kMostEdsFaults = 100;
// More objects than a dictionary of drives has by far: files of more are refused, so that memory stays bounded.
inline constexpr std::size_t kMostEdsObjects = 20'000;

// Throws std::runtime_error with line and reason if the text is no EDS or DCF at all: no section, or none of an object.
EdsFile read_eds(std::string_view text);

}  // namespace kenaf::canopen
