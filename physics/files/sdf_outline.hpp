// The text of an SDF file (http://sdformat.org), cut down to what this simulator reads.
//
// An outline is a tree of parts: the world, and each model, link, collision and frame in it, without those in them. So
// libsdformat reads one at a time, as it takes 2.5 MB for a model with all that may be in it. What has no effect here
// (visuals, sensors, plugins, ...) never reaches libsdformat and cannot make it refuse a world; it is noted with its
// line. What SDF 1.6 and earlier say otherwise is put as SDF 1.9 says it.
//
// Thread safety: pure functions, but for the notes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "physics/files/sdf_notes.hpp"

namespace kenaf::physics {

// Models in models, whether written there or included: a world's own models have a depth of 1.
inline constexpr int kMostNestedModels = 16;
// Of one file, '<' and '=' counted: as much as a file of 16 MiB can hold would take 500 MB as a document.
inline constexpr std::size_t kMostMarks = 1'000'000;
// Of one element: reading them takes quadratic time.
inline constexpr std::size_t kMostAttributes = 1000;

struct SdfPart {
  std::string file;         // for errors
  std::string version;      // of the file, such as "1.6"
  int line = 1;             // of the element in the file
  std::string kind;         // "world", "model", "link", "collision" or "frame"
  std::string document;     // SDF 1.9 with this element alone in a world, without its parts; line 1 is `line`
  std::string include_uri;  // not empty: the model is another file's, `document` has what the <include> says of it
  std::vector<SdfPart> parts;
};

// Returns the only <world> of a file. `file` is for errors and notes. Throws DescriptionError ("file:line: what") if
// the text is no XML document, has no <sdf> with a version, not exactly one <world>, models nested deeper than
// kMostNestedModels, more than kMostMarks or
// kMostAttributes, or a <polyline> of more than 500 points.
SdfPart outline_world(std::string_view text, const std::string& file, SdfNotes& notes);

// Returns the first <model> of a file, or nothing if there is none. Throws as above.
std::optional<SdfPart> outline_model(std::string_view text, const std::string& file, SdfNotes& notes);

}  // namespace kenaf::physics
