#include "gap/recordings/recording.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <utility>

#include "gap/recordings/byte_source.hpp"
#include "gap/recordings/decompress.hpp"
#include "gap/recordings/mcap_reader.hpp"
#include "gap/recordings/recording_error.hpp"
#include "gap/recordings/rosbag1_reader.hpp"
#include "gap/recordings/sqlite_bag.hpp"

namespace kenaf::gap::recordings {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostTopics = 10000;  // chosen, of time: each is compared with all before

std::string first_bytes(const fs::path& file) {
  const ByteSource source = bytes_of_file(file);
  return read_bytes(source, 0, std::min<std::uint64_t>(source.size, 16));
}

bool begins_as_recording(std::string_view bytes) {
  return begins_as_mcap(bytes) || begins_as_rosbag1(bytes) || begins_as_sqlite(bytes) || begins_as_zstd(bytes);
}

// A file that is removed with its last owner.
std::shared_ptr<const fs::path> temporary_file() {
  std::string name = (fs::temp_directory_path() / "kenaf-import-XXXXXX").string();
  const int descriptor = ::mkstemp(name.data());
  if (descriptor < 0) throw RecordingError(name + ": cannot be created; is the disk full?");
  ::close(descriptor);
  return {new fs::path(name), [](const fs::path* path) {
            std::error_code ignored;
            fs::remove(*path, ignored);
            delete path;
          }};
}

Recording open_file(const fs::path& file);

// SQLite needs a file, and other readers read here and there: the whole is unpacked to the disk.
Recording open_packed(const fs::path& file) {
  const std::shared_ptr<const fs::path> unpacked = temporary_file();
  decompress_zstd_file(file, *unpacked);
  if (begins_as_zstd(first_bytes(*unpacked))) throw RecordingError("it is packed by zstd twice");
  Recording recording = open_file(*unpacked);
  recording.visit = [visit = recording.visit, unpacked](const TakeMessage& take, const TellProgress& tell) {
    return visit(take, tell);
  };
  return recording;
}

Recording open_file(const fs::path& file) {
  const std::string begin = first_bytes(file);
  if (begins_as_mcap(begin)) return open_mcap(bytes_of_file(file));
  if (begins_as_rosbag1(begin)) return open_rosbag1(bytes_of_file(file));
  if (begins_as_sqlite(begin)) return open_sqlite_bag(file);
  if (begins_as_zstd(begin)) return open_packed(file);
  throw RecordingError("it is no MCAP file, no rosbag and no SQLite file");
}

Recording open_named(const fs::path& file) try { return open_file(file); } catch (const RecordingError& error) {
  const std::string what = error.what();
  throw RecordingError(what.starts_with(file.string()) ? what : file.string() + ": " + what);
}

// The number before the extensions of "name_12.db3.zstd"; recorders count the pieces of a recording.
std::pair<std::string, unsigned long> piece_number(const fs::path& file) {
  std::string stem = file.filename().string();
  stem = stem.substr(0, stem.find('.'));
  std::size_t digits = stem.size();
  while (digits > 0 && std::isdigit(static_cast<unsigned char>(stem[digits - 1])) != 0) --digits;
  const std::string number = stem.substr(digits).substr(0, 9);
  return {stem.substr(0, digits), number.empty() ? 0 : std::stoul(number)};
}

std::vector<fs::path> pieces_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && begins_as_recording(first_bytes(entry.path()))) files.push_back(entry.path());
  std::ranges::sort(files, {}, piece_number);
  if (files.empty())
    throw RecordingError(folder.string() + ": a folder without MCAP files and SQLite files of rosbag2");
  return files;
}

struct Piece {
  Recording recording;
  std::vector<std::size_t> topic;  // its topics' places among those of all
};

void add_remarks(std::vector<std::string>& remarks, const fs::path& file, const std::vector<std::string>& more) {
  for (const std::string& remark : more) remarks.push_back(file.filename().string() + ": " + remark);
}

std::vector<std::string> visit_pieces(const std::vector<Piece>& pieces, const std::vector<fs::path>& files,
                                      const TakeMessage& take, const TellProgress& tell) {
  std::vector<std::string> remarks;
  bool goes_on = true;
  for (std::size_t i = 0; i < pieces.size() && goes_on; ++i) {
    const Piece& piece = pieces[i];
    const auto take_of_piece = [&](const Message& message) {
      return goes_on = take({piece.topic[message.topic], message.log_ns, message.bytes});
    };
    const auto tell_of_piece = [&](double share) {
      if (tell) tell((static_cast<double>(i) + share) / static_cast<double>(pieces.size()));
    };
    add_remarks(remarks, files[i], piece.recording.visit(take_of_piece, tell_of_piece));
  }
  return remarks;
}

Recording open_folder(const fs::path& folder) {
  const std::vector<fs::path> files = pieces_in(folder);
  auto pieces = std::make_shared<std::vector<Piece>>();
  Recording whole;
  for (const fs::path& file : files) {
    Piece piece{open_named(file), {}};
    const Recording& part = piece.recording;
    for (const Topic& topic : part.topics) {
      piece.topic.push_back(topic_index(whole.topics, topic));
      whole.topics[piece.topic.back()].count += topic.count;
    }
    whole.form = part.form;
    widen_times(whole, part.first_ns, part.last_ns);
    add_remarks(whole.remarks, file, part.remarks);
    pieces->push_back(std::move(piece));
  }
  whole.visit = [pieces, files](const TakeMessage& take, const TellProgress& tell) {
    return visit_pieces(*pieces, files, take, tell);
  };
  return whole;
}

}  // namespace

void widen_times(Recording& recording, std::int64_t first_ns, std::int64_t last_ns) {
  if (first_ns == 0 && last_ns == 0) return;
  const bool is_first = recording.first_ns == 0 && recording.last_ns == 0;
  recording.first_ns = is_first ? first_ns : std::min(recording.first_ns, first_ns);
  recording.last_ns = is_first ? last_ns : std::max(recording.last_ns, last_ns);
}

std::size_t topic_index(std::vector<Topic>& topics, const Topic& topic) {
  const auto same = std::ranges::find_if(topics, [&topic](const Topic& known) {
    return known.name == topic.name && known.type == topic.type && known.message_encoding == topic.message_encoding &&
           known.schema_encoding == topic.schema_encoding;
  });
  if (same != topics.end()) return static_cast<std::size_t>(same - topics.begin());
  if (topics.size() == kMostTopics) throw RecordingError(fmt::format("it has more than {} topics", kMostTopics));
  topics.push_back(topic);
  topics.back().count = 0;
  return topics.size() - 1;
}

Recording open_recording(const fs::path& path) {
  return fs::is_directory(path) ? open_folder(path) : open_named(path);
}

bool is_recording(const fs::path& path) {
  return fs::is_directory(path) || begins_as_recording(first_bytes(path));
}

}  // namespace kenaf::gap::recordings
