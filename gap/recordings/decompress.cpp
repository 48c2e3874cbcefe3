#include "gap/recordings/decompress.hpp"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <memory>
#include <span>

#include "gap/recordings/byte_source.hpp"
#include "gap/recordings/recording_error.hpp"

namespace kenaf::gap::recordings {
namespace {

constexpr std::size_t kPiece = 1 << 16;
constexpr std::string_view kZstdMagic = "\x28\xB5\x2F\xFD";  // RFC 8878, section 3.1.1

[[noreturn]] void fail_unpacking(const char* method, const char* why) {
  throw RecordingError(fmt::format("its {} data is damaged: {}", method, why));
}

// One step of a method: takes from the front of `in`, fills from the front of `out`; both shrink. Returns whether the
// data has ended.
using Step = std::function<bool(std::string_view& in, std::span<char>& out)>;

// Calls `step` until the data ends. Throws where it makes no progress, or makes more than `most` bytes.
std::string unpack(const char* method, std::string_view in, std::uint64_t most, const Step& step) {
  std::string out;
  std::size_t filled = 0;
  for (bool ended = false; !ended;) {
    if (filled == out.size()) out.resize(std::min<std::uint64_t>(std::max(kPiece, 2 * out.size()), most + 1));
    std::span<char> room(out.data() + filled, out.size() - filled);
    const std::size_t in_before = in.size(), room_before = room.size();
    ended = step(in, room);
    filled += room_before - room.size();
    if (filled > most) fail_unpacking(method, fmt::format("it unpacks to more than {} bytes", most).c_str());
    if (!ended && in.size() == in_before && room.size() == room_before) fail_unpacking(method, "it ends too early");
  }
  out.resize(filled);
  return out;
}

std::string unpack_lz4(std::string_view bytes, std::uint64_t most) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(made,
                                                                                     &LZ4F_freeDecompressionContext);
  return unpack("lz4", bytes, most, [&context](std::string_view& in, std::span<char>& out) {
    std::size_t used = in.size(), made_bytes = out.size();
    const std::size_t left = LZ4F_decompress(context.get(), out.data(), &made_bytes, in.data(), &used, nullptr);
    if (LZ4F_isError(left) != 0) fail_unpacking("lz4", LZ4F_getErrorName(left));
    in.remove_prefix(used);
    out = out.subspan(made_bytes);
    return left == 0;
  });
}

using ZstdContext = std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)>;

ZstdContext zstd_context() {
  ZstdContext context(ZSTD_createDCtx(), &ZSTD_freeDCtx);
  if (!context) throw std::bad_alloc();
  // A frame may ask for a window; beyond 2^27 bytes, zstd's own default limit, it is refused.
  ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, 27);
  return context;
}

bool zstd_step(ZSTD_DCtx* context, std::string_view& in, std::span<char>& out) {
  ZSTD_inBuffer input{in.data(), in.size(), 0};
  ZSTD_outBuffer output{out.data(), out.size(), 0};
  const std::size_t left = ZSTD_decompressStream(context, &output, &input);
  if (ZSTD_isError(left) != 0) fail_unpacking("zstd", ZSTD_getErrorName(left));
  in.remove_prefix(input.pos);
  out = out.subspan(output.pos);
  return left == 0 && in.empty();
}

std::string unpack_zstd(std::string_view bytes, std::uint64_t most) {
  const ZstdContext context = zstd_context();
  return unpack("zstd", bytes, most,
                [&context](std::string_view& in, std::span<char>& out) { return zstd_step(context.get(), in, out); });
}

std::string unpack_bz2(std::string_view bytes, std::uint64_t most) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> end(&stream, &BZ2_bzDecompressEnd);
  return unpack("bz2", bytes, most, [&stream](std::string_view& in, std::span<char>& out) {
    // The library's pointers are not const, but it only reads the input.
    stream.next_in = const_cast<char*>(in.data());
    stream.avail_in = static_cast<unsigned>(std::min<std::size_t>(in.size(), 1 << 30));
    stream.next_out = out.data();
    stream.avail_out = static_cast<unsigned>(std::min<std::size_t>(out.size(), 1 << 30));
    const int result = BZ2_bzDecompress(&stream);
    if (result != BZ_OK && result != BZ_STREAM_END) fail_unpacking("bz2", "its blocks do not fit their checksums");
    in.remove_prefix(static_cast<std::size_t>(stream.next_in - in.data()));
    out = out.subspan(static_cast<std::size_t>(stream.next_out - out.data()));
    return result == BZ_STREAM_END;
  });
}

std::string unpack_at_most(Compression compression, std::string_view bytes, std::uint64_t most) {
  switch (compression) {
    case Compression::none:
      return std::string(bytes);
    case Compression::lz4:
      return unpack_lz4(bytes, most);
    case Compression::zstd:
      return unpack_zstd(bytes, most);
    case Compression::bz2:
      return unpack_bz2(bytes, most);
  }
  throw std::logic_error("unknown compression");
}

}  // namespace

std::optional<Compression> compression_of(std::string_view name) {
  if (name.empty() || name == "none") return Compression::none;
  if (name == "lz4") return Compression::lz4;
  if (name == "zstd") return Compression::zstd;
  if (name == "bz2") return Compression::bz2;
  return std::nullopt;
}

std::string decompressed(Compression compression, std::string_view bytes, std::uint64_t size) {
  if (size > kLargestBlock)
    throw RecordingError(fmt::format("it is to unpack to {} bytes, more than {}", size, kLargestBlock));
  std::string unpacked = unpack_at_most(compression, bytes, size);
  if (unpacked.size() != size)
    throw RecordingError(fmt::format("it unpacks to {} bytes instead of {}", unpacked.size(), size));
  return unpacked;
}

std::string decompressed(Compression compression, std::string_view bytes) {
  return unpack_at_most(compression, bytes, kLargestBlock);
}

bool begins_as_zstd(std::string_view bytes) {
  return bytes.starts_with(kZstdMagic);
}

void decompress_zstd_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  const ByteSource source = bytes_of_file(from);
  std::ofstream file(to, std::ios::binary | std::ios::trunc);
  const ZstdContext context = zstd_context();
  std::string in_piece, out_piece(kPiece, '\0');
  bool ended = false;
  for (std::uint64_t at = 0; at < source.size; at += in_piece.size()) {
    in_piece = read_bytes(source, at, std::min<std::uint64_t>(kPiece, source.size - at));
    std::string_view in = in_piece;
    // Until the piece is used up and the method holds nothing back.
    for (std::span<char> out; !in.empty() || out.empty();) {
      out = out_piece;
      ended = zstd_step(context.get(), in, out);
      file.write(out_piece.data(), static_cast<std::streamsize>(out_piece.size() - out.size()));
      if (ended) break;
    }
  }
  file.flush();
  if (!ended) throw RecordingError(from.string() + ": its zstd data is cut off");
  if (!file) throw RecordingError(to.string() + ": cannot be written; is the disk full?");
}

std::string compressed_zstd(std::string_view bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), ZSTD_CLEVEL_DEFAULT);
  if (ZSTD_isError(size) != 0) throw std::runtime_error(ZSTD_getErrorName(size));
  packed.resize(size);
  return packed;
}

}  // namespace kenaf::gap::recordings
