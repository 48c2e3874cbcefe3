// A world's outline with all models that it includes, as one tree of elements of libsdformat.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "physics/files/sdf_elements.hpp"
#include "physics/files/sdf_notes.hpp"
#include "physics/files/sdf_outline.hpp"
#include "physics/files/world_files.hpp"

namespace kenaf::physics {

class SdfAssembly {
 public:
  // Chosen: a world at these limits takes less than 512 MiB and some seconds. libsdformat takes quadratic time for
  // links and frames, and for each pose as long as its chain of poses is.
  static constexpr std::size_t kMostModels = 5000, kMostLinks = 5000, kMostShapes = 20'000, kMostFrames = 2000;
  static constexpr int kLongestChain = 100;  // of poses that are relative to the next, in one model or world

  SdfAssembly(WorldFiles& files, SdfNotes& notes) : files_(files), notes_(notes) {}

  // Returns the <world> with its models in it, those of <include> in their places: named, placed and made static as the
  // <include> says (http://sdformat.org/tutorials?tut=composition). An <include> that is not found, not local or holds
  // no model is noted and left out. Throws DescriptionError ("file:line: what") for files as WorldFiles and the outline
  // do, if a file includes itself (with the chain of files), and beyond the limits.
  sdf::ElementPtr assemble(const SdfPart& world);

 private:
  sdf::ElementPtr element_of(const SdfPart& part, int depth);
  sdf::ElementPtr included(const SdfPart& include, int depth);
  std::optional<std::filesystem::path> file_of(const SdfPart& include);
  const std::optional<SdfPart>& outline_of(const std::filesystem::path& file);
  void count(const SdfPart& part);

  WorldFiles& files_;
  SdfNotes& notes_;
  std::vector<std::filesystem::path> chain_;  // of files, the outermost first
  std::map<std::filesystem::path, std::optional<SdfPart>> outlines_;
  std::size_t models_ = 0, links_ = 0, shapes_ = 0, frames_ = 0;
};

}  // namespace kenaf::physics
