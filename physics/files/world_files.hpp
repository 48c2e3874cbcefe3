// The files that a world refers to: meshes, height maps, models. They are read from the folders that are named for it
// and from nowhere else.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kenaf::physics {

class WorldFiles {
 public:
  static constexpr std::size_t kMostFileBytes = std::size_t{16} << 20U;
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20U;        // of all files together
  static constexpr std::size_t kMostConfigBytes = std::size_t{64} << 10U;  // of a model.config

  // `world_file` is the world's name in places of errors. `own` is its folder; empty: it has none. Folders that do not
  // exist are left out; without any, the world may not refer to files.
  WorldFiles(std::string world_file, const std::filesystem::path& own,
             const std::vector<std::filesystem::path>& search);

  // Whether a URI can name a file of this machine.
  static bool is_local(const std::string& uri);

  bool has_folders() const { return !folders_.empty(); }

  // Looks for the file that `uri` names in the file `named_in`, in this order:
  //   "a/b.stl", "file://a/b.stl"   in the folder of `named_in`, in the world's folder, in the search path's folders
  //   "model://a/b.stl"             in the world's folder, in the search path's folders
  //   "/x/b.stl", "file:///x/b.stl" there
  // Returns its path without links. Throws DescriptionError (without a place) if there is none, or if it is outside of
  // these folders, also through ".." or a link.
  std::filesystem::path find(const std::string& uri, const std::string& named_in) const;

  // Looks for a model in the same way. If `uri` names a folder, the model is the file that its model.config names for
  // the newest version of SDF up to 1.9, or model.sdf. Returns nothing if there is none. Throws as find() and read(),
  // and if a model.config has more than kMostConfigBytes or names no file.
  std::optional<std::filesystem::path> find_model(const std::string& uri, const std::string& named_in);

  // Returns the bytes of a file that was found; its size counts each time. Throws DescriptionError (without a place) if
  // it is no regular file, has more than kMostFileBytes, or more than kMostBytes together with all that were read
  // before.
  std::string read(const std::filesystem::path& file) { return read_at_most(file, kMostFileBytes); }

  // The folders, for errors.
  std::string folders_in_words() const;

 private:
  std::optional<std::filesystem::path> look_for(const std::string& uri, const std::string& named_in) const;
  std::string read_at_most(const std::filesystem::path& file, std::size_t most_bytes);
  bool is_allowed(const std::filesystem::path& canonical) const;
  std::filesystem::path model_in(const std::filesystem::path& folder);

  std::string world_file_;
  std::vector<std::filesystem::path> folders_;  // without links: the world's own, then the search path's
  std::size_t bytes_left_ = kMostBytes;
  std::map<std::filesystem::path, std::filesystem::path> models_;  // by their folders
};

}  // namespace kenaf::physics
