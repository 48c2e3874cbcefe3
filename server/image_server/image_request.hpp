// What a client of the image server sends: USARSim's OK and U, and what was added to it. docs/cameras.md has the
// protocol.
//
// One byte at a time, as they may come; what is no request is skipped, as USARSim's server did. Holds 255 bytes at
// most.
//
// Thread safety: none.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kenaf::image_server {

struct ImageRequest {
  enum class Kind { picture, part, jpeg };  // OK, U, J
  Kind kind = Kind::picture;
  std::uint32_t x = 0, y = 0, width = 0, height = 0;  // of a part, as sent: whatever
  std::string view{};                                 // V's bytes as sent; empty: the default
  bool knows_words = false;  // the client has sent V or J, so it knows what was added to USARSim's protocol
};

class ImageRequestParser {
 public:
  // Takes bytes from the front of `bytes`, until a request is whole or none are left.
  std::optional<ImageRequest> take(std::string_view& bytes);

 private:
  enum class State { idle, after_o, part, view_length, view };

  State state_ = State::idle;
  std::array<unsigned char, 16> part_{};
  std::size_t count_ = 0, length_ = 0;  // of what is under way
  std::string coming_, view_;
  bool knows_words_ = false;
};

}  // namespace kenaf::image_server
