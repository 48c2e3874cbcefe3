// Requests of the image server's clients: USARSim's OK and U, and Kenaf's additions. docs/cameras.md has the protocol.
//
// Parses byte by byte, as requests may arrive in pieces; anything else is skipped, as USARSim's server did. Holds at
// most 255 bytes.
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
  std::uint32_t x = 0, y = 0, width = 0, height = 0;  // of a part, as sent: unchecked
  std::string view{};                                 // V's bytes as sent; empty: the default
  bool knows_words = false;  // the client has sent V or J, so it knows Kenaf's additions to the protocol
};

class ImageRequestParser {
 public:
  // Consumes bytes from the front of `bytes`, until a request is complete or none are left.
  std::optional<ImageRequest> take(std::string_view& bytes);

 private:
  enum class State { idle, after_o, part, view_length, view };

  State state_ = State::idle;
  std::array<unsigned char, 16> part_{};
  std::size_t count_ = 0, length_ = 0;  // of the request under way
  std::string coming_, view_;
  bool knows_words_ = false;
};

}  // namespace kenaf::image_server
