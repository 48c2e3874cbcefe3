// Reads the numbers in the messages of one topic, whatever they are encoded in.
//
// Thread safety: pure functions and values.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "gap/recordings/field_path.hpp"
#include "gap/recordings/field_value.hpp"
#include "gap/recordings/message_definition.hpp"
#include "gap/recordings/recording.hpp"

namespace kenaf::gap::recordings {

class MessageReader {
 public:
  // Definitions come from the recording; where it has none from `more`, then from standard_definitions(). Throws
  // RecordingError with why messages of this topic cannot be read: no definition, one in IDL, another encoding.
  MessageReader(const Topic& topic, const DefinitionTexts& more);

  // Returns why no message can have a number at `path`; empty if it can, or if only messages can tell (JSON).
  std::string wrong_with(const FieldPath& path) const;

  // Calls `take` for the numbers at the paths, with which nothing is wrong, in their order; empty where the message has
  // no such element. Throws RecordingError where the message is damaged, after it has given what comes before.
  void find(std::string_view message, std::span<const FieldPath> paths, const TakeFound& take) const;
  std::optional<FieldValue> find(std::string_view message, const FieldPath& path) const;
  void list(std::string_view message, const TakeField& take) const;

 private:
  struct Json {};
  struct Serialised {
    Definitions definitions;
    RosVersion version;
  };
  std::variant<Json, Serialised> how_;
};

}  // namespace kenaf::gap::recordings
