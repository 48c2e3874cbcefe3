// A node's object dictionary: the objects that a master can read and write, by SDO one at a time, by PDO in the control
// loop. CiA 301, 7.4.
//
// The dictionary keeps the values and the general rules (existence, access, length, limits); the node adds its own
// rules and reactions through on_check and on_written.
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
enum class Mappable : std::uint8_t { no, transmit, receive, both };  // kinds of PDO, as seen by the node

struct ObjectLimits {
  std::int64_t min, max;
};
ObjectLimits range_of(canopen::ObjectType type);  // the full range of the type; not for text

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
  // `value` is also the value after a reset. Limits: the full range of the type.
  void add(const canopen::MappedObject& object, Access access, Mappable mappable, std::int64_t value);
  void add(const canopen::MappedObject& object, Access access, Mappable mappable, std::int64_t value,
           ObjectLimits limits);
  void add_text(canopen::ObjectAddress object, std::string text);

  const ObjectEntry* find(canopen::ObjectAddress object) const;  // nullptr if there is none
  // Throws std::out_of_range if there is no such object. set: by the node itself, without any check.
  std::int64_t value(canopen::ObjectAddress object) const;
  void set(canopen::ObjectAddress object, std::int64_t value);
  // Resets all objects with an index from `first` to `last` to their initial values.
  void reset(std::uint16_t first, std::uint16_t last);

  // Read and write as a master does by SDO.
  std::variant<canopen::ObjectBytes, canopen::SdoAbort> read(canopen::ObjectAddress object) const;
  std::optional<canopen::SdoAbort> write(canopen::ObjectAddress object, std::span<const std::uint8_t> bytes);
  // Writes as PDOs do: all values are in the dictionary before the first on_written, so that a controlword finds its
  // target, whatever their order in the PDO. A value that SDO would refuse is skipped: a PDO has no answer.
  struct Number {
    canopen::ObjectAddress object;
    std::int64_t value;
  };
  void write_together(std::span<const Number> numbers);

  std::function<std::optional<canopen::SdoAbort>(canopen::ObjectAddress, std::int64_t)> on_check;
  std::function<void(canopen::ObjectAddress, std::int64_t)> on_written;  // called after the value is in the dictionary

 private:
  std::optional<canopen::SdoAbort> missing(canopen::ObjectAddress object) const;
  std::optional<canopen::SdoAbort> store(canopen::ObjectAddress object, std::int64_t value);

  struct Hash {
    std::size_t operator()(canopen::ObjectAddress object) const {
      return static_cast<std::size_t>(object.index) << 8 | object.sub;
    }
  };
  std::unordered_map<canopen::ObjectAddress, ObjectEntry, Hash> entries_;  // looked up many times per step
};

}  // namespace kenaf::candrives
