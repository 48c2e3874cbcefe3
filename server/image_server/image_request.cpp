#include "server/image_server/image_request.hpp"

namespace kenaf::image_server {

namespace {

std::uint32_t big_endian(const unsigned char* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 | bytes[3];
}

}  // namespace

std::optional<ImageRequest> ImageRequestParser::take(std::string_view& bytes) {
  // Completes a request; view_ and knows_words_ are kept for later ones.
  const auto whole = [this](ImageRequest::Kind kind) {
    state_ = State::idle;
    ImageRequest request;
    request.kind = kind;
    request.view = view_;
    request.knows_words = knows_words_;
    return request;
  };

  // One byte at a time: a request may come in several pieces, and state_ persists between calls.
  while (!bytes.empty()) {
    const char byte = bytes.front();
    bytes.remove_prefix(1);
    switch (state_) {
      // "OK"; after an 'O' any other byte is taken as the first of a new request.
      case State::after_o:
        if (byte == 'K') return whole(ImageRequest::Kind::picture);
        state_ = State::idle;
        [[fallthrough]];
      // The first byte says which request begins, and whether the client knows Kenaf's words; other bytes are skipped.
      case State::idle:
        count_ = 0;
        if (byte == 'O') state_ = State::after_o;
        if (byte == 'U') state_ = State::part;
        if (byte == 'V') state_ = State::view_length;
        if (byte == 'V' || byte == 'J') knows_words_ = true;
        if (byte == 'J') return whole(ImageRequest::Kind::jpeg);
        break;
      // 'U': a part of the picture, as four big-endian numbers.
      case State::part:
        part_[count_++] = static_cast<unsigned char>(byte);
        if (count_ == part_.size()) {
          ImageRequest request = whole(ImageRequest::Kind::part);
          request.x = big_endian(&part_[0]);
          request.y = big_endian(&part_[4]);
          request.width = big_endian(&part_[8]);
          request.height = big_endian(&part_[12]);
          return request;
        }
        break;
      // 'V': a length and as many bytes, the name of the view for this and all later requests; length 0 means the
      // default.
      case State::view_length:
        length_ = static_cast<unsigned char>(byte);
        coming_.clear();
        state_ = State::view;
        if (length_ == 0) {
          view_.clear();
          state_ = State::idle;
        }
        break;
      case State::view:
        coming_ += byte;
        if (coming_.size() == length_) {
          view_ = coming_;
          state_ = State::idle;
        }
        break;
    }
  }
  return std::nullopt;
}

}  // namespace kenaf::image_server
