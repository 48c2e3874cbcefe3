// A node's object dictionary: what a master can read and write of it, by SDO one object at a time, by PDO in the
// control loop. CiA 301, 7.4.
//
// The dictionary keeps the values and the general rules (exists, may be written, has this length, lies within these
// limits); what else a write must meet, and what follows from it, the node says itself: on_check and on_written.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <variant>

#include "can/canopen/pdo.hpp"
#include "can/canopen/sdo.hpp"

namespace kenaf::candrives {

enum class Access : std::uint8_t { read_only, read_write };
enum class Mappable : std::uint8_t { no, transmit, receive, both };  // into which PDOs, as the node sees them

struct ObjectLimits {
  std::int64_t min, max;
};
ObjectLimits range_of(canopen::ObjectType type);  // of everything that fits; not for text

struct ObjectEntry {
  canopen::ObjectType type{};
  Access access = Access::read_only;
  Mappable mappable = Mappable::no;
  std::int64_t value = 0, value_at_reset = 0;
  ObjectLimits limits{};
  std::string text;  // of type text
};

class Dictionary {
 public:
  // `value` is the object's value after a reset too. Limits: all that fits the type.
  void add(const canopen::MappedObject& object, Access access, Mappable mappable, std::int64_t value);
  void add(const canopen::MappedObject& object, Access access, Mappable mappable, std::int64_t value,
           ObjectLimits limits);
  void add_text(canopen::ObjectAddress object, std::string text);

  const ObjectEntry* find(canopen::ObjectAddress object) const;  // nullptr: there is none
  // Of an object that there is, else std::out_of_range. set: by the node itself, without any check.
  std::int64_t value(canopen::ObjectAddress object) const;
  void set(canopen::ObjectAddress object, std::int64_t value);
  // All objects with an index from `first` to `last` as they were added.
  void reset(std::uint16_t first, std::uint16_t last);

  // As a master reads and writes by SDO.
  std::variant<canopen::ObjectBytes, canopen::SdoAbort> read(canopen::ObjectAddress object) const;
  std::optional<canopen::SdoAbort> write(canopen::ObjectAddress object, std::span<const std::uint8_t> bytes);
  // As PDOs write: all values are in the dictionary before on_written hears of the first, so that a controlword finds
  // the target beside it, whatever the order in the PDO. A value that would be refused by SDO is left out: a PDO has no
  // answer.
  struct Number {
    canopen::ObjectAddress object;
    std::int64_t value;
  };
  void write_together(std::span<const Number> numbers);

  std::function<std::optional<canopen::SdoAbort>(canopen::ObjectAddress, std::int64_t)> on_check;
  std::function<void(canopen::ObjectAddress, std::int64_t)> on_written;  // the value is in the dictionary already

 private:
  std::optional<canopen::SdoAbort> missing(canopen::ObjectAddress object) const;
  std::optional<canopen::SdoAbort> store(canopen::ObjectAddress object, std::int64_t value);

  struct Hash {
    std::size_t operator()(canopen::ObjectAddress object) const {
      return static_cast<std::size_t>(object.index) << 8 | object.sub;
    }
  };
  std::unordered_map<canopen::ObjectAddress, ObjectEntry, Hash> entries_;  // asked many times a step
};

}  // namespace kenaf::candrives
