// A world with all models that it includes, as one tree.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "physics/files/sdf_document.hpp"
#include "physics/files/sdf_element.hpp"
#include "physics/files/sdf_notes.hpp"
#include "physics/files/world_files.hpp"

namespace kenaf::physics {

class SdfAssembly {
 public:
  // Chosen: a world at these limits takes less than 512 MiB and some seconds. They are what bounds a file that includes
  // another ten times, which includes another ten times.
  static constexpr std::size_t kMostModels = 5000, kMostLinks = 5000, kMostShapes = 20'000, kMostFrames = 20'000;

  SdfAssembly(WorldFiles& files, SdfNotes& notes) : files_(files), notes_(notes) {}

  // Replaces each <include> in a <world> by its model, or by what is in it (sdf_merge.hpp): named, placed and made
  // static as the <include> says (http://sdformat.org/tutorials?tut=composition). One that is not found, not local or
  // holds no model is noted and left out. Throws DescriptionError ("file:line: what") for files as WorldFiles and
  // sdf_document.hpp do, if a file includes itself (with the chain of files), and beyond the limits.
  SdfElement assemble(SdfElement world);

 private:
  void put_includes(SdfElement& parent, int depth);
  bool is_merged(const SdfElement& include, const SdfElement& model, const SdfElement& parent);
  std::optional<SdfElement> included(const SdfElement& include, int depth);
  std::optional<std::filesystem::path> file_of(const SdfElement& include);
  const std::optional<SdfElement>& model_of(const std::filesystem::path& file);
  void count(const SdfElement& element);

  WorldFiles& files_;
  SdfNotes& notes_;
  std::vector<std::filesystem::path> chain_;  // of files, the outermost first
  std::map<std::filesystem::path, std::optional<SdfElement>> models_by_file_;
  std::size_t models_ = 0, links_ = 0, shapes_ = 0, frames_ = 0;
};

}  // namespace kenaf::physics
