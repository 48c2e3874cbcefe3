#include "server/image_server/image_connection.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <optional>

#include "formats/protocol/foreign_opening.hpp"
#include "server/image_server/image_request.hpp"
#include "server/image_server/raw_picture.hpp"
#include "server/world_server/peer_life.hpp"

namespace kenaf::image_server {

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;
using FramePtr = std::shared_ptr<const Frame>;

constexpr std::uint8_t kWords = 255;
// Handed to the system in one call.
constexpr std::size_t kMostAtOnce = 1 << 20;
// Period at which a waiting request asks for its view: shorter than the feed's memory.
constexpr std::chrono::milliseconds kLookAgain{250};

Clock::duration duration_of(double s) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
}

class ImageConnection final : public ImageReader, public std::enable_shared_from_this<ImageConnection> {
 public:
  ImageConnection(ImageDesk& desk, tcp::socket socket)
      : desk_(desk), socket_(std::move(socket)), look_again_(socket_.get_executor()), unread_(socket_.get_executor()) {}
  ~ImageConnection() { std::erase(desk_.readers, this); }  // it may end by an exception
  ImageConnection(const ImageConnection&) = delete;
  ImageConnection& operator=(const ImageConnection&) = delete;

  void start();
  void look() override;
  std::optional<Clock::time_point> idle_since() const override {
    return request_ || sending_ ? std::nullopt : std::optional(busy_);
  }
  void give_way() override { close(); }

 private:
  void read();
  void take(std::string_view bytes);
  void look_later(Clock::duration after);
  void answer(const FramePtr& frame);
  void send_words(const std::string& words);
  void send(std::uint8_t type, std::size_t size);
  void watch_reading();
  void close();

  ImageDesk& desk_;
  tcp::socket socket_;
  asio::steady_timer look_again_, unread_;
  std::array<char, 4096> received_;
  protocol::Opening opening_;
  ImageRequestParser parser_;
  Clock::time_point busy_ = Clock::now();  // when it last asked or had been sent something

  std::optional<ImageRequest> request_;  // the newest without an answer; earlier ones are dropped
  Clock::time_point asked_, words_until_{};
  CameraId had_{};  // the last frame sent, and its number
  std::uint64_t had_number_ = 0;

  // Data being sent: header, start, rest.
  FramePtr frame_;
  bool sending_ = false;
  std::array<std::uint8_t, 5> header_{};
  std::string start_;
  Bytes made_;
  std::array<asio::const_buffer, 3> out_;
  bool open_ = true;
};

void ImageConnection::start() {
  desk_.readers.push_back(this);
  error_code ignored;
  socket_.set_option(tcp::no_delay(true), ignored);
  world_server::end_with_peer(socket_.native_handle());
  socket_.set_option(asio::socket_base::send_buffer_size(desk_.limits.send_buffer_bytes), ignored);
  read();
}

void ImageConnection::read() {
  socket_.async_read_some(asio::buffer(received_), [self = shared_from_this()](error_code error, std::size_t count) {
    if (!self->open_) return;
    if (error) return self->close();
    self->take({self->received_.data(), count});
    if (self->open_) self->read();
  });
}

void ImageConnection::take(std::string_view bytes) {
  if (const std::string_view protocol = opening_.take(bytes); !protocol.empty()) {
    if (desk_.log.allow()) spdlog::warn("image server: closed a reader: it speaks {}, not USARSim", protocol);
    return close();
  }
  const bool waited = request_.has_value();
  busy_ = Clock::now();
  while (auto request = parser_.take(bytes)) request_ = std::move(request);
  if (!request_) return;
  if (!waited) asked_ = Clock::now();
  look();
}

void ImageConnection::look() {
  if (!open_ || !request_ || sending_) return;
  const Feed::Look seen = desk_.feed.look(request_->view);
  const Clock::time_point now = Clock::now();
  // A client of 2008 expects a picture and understands no text answers: it can only wait for one.
  const bool waits_for_picture = !request_->knows_words;
  if (!seen.none.empty() && !waits_for_picture) {
    if (now < words_until_) return look_later(words_until_ - now);
    return send_words(seen.none);
  }
  const double waited_s = std::chrono::duration<double>(now - asked_).count();
  const bool is_new = seen.frame && (seen.frame->id != had_ || seen.frame->number != had_number_);
  if (is_new || (seen.frame && waited_s >= desk_.limits.repeat_s)) return answer(seen.frame);
  if (!seen.frame && waits_for_picture) return look_later(kLookAgain);
  if (!seen.frame && waited_s >= desk_.limits.first_s) return send_words("the world server has no picture yet");
  const double until_s = (seen.frame ? desk_.limits.repeat_s : desk_.limits.first_s) - waited_s;
  look_later(std::min<Clock::duration>(kLookAgain, duration_of(until_s)));
}

void ImageConnection::look_later(Clock::duration after) {
  look_again_.expires_after(after);
  look_again_.async_wait([self = shared_from_this()](error_code cancelled) {
    if (!cancelled) self->look();
  });
}

void ImageConnection::answer(const FramePtr& frame) {
  // Remembered, so that the next request waits for another frame; held, because out_ points into it.
  had_ = frame->id;
  had_number_ = frame->number;
  frame_ = frame;

  // A part: raw pixels, cut out for this client alone.
  if (request_->kind == ImageRequest::Kind::part) {
    auto part = raw_picture(frame->image->picture, request_->x, request_->y, request_->width, request_->height);
    if (part.empty()) return send_words("that part lies outside the picture");
    made_ = std::make_shared<const std::vector<std::uint8_t>>(std::move(part));
    out_ = {asio::const_buffer(), asio::const_buffer(), asio::buffer(*made_)};
    return send(static_cast<std::uint8_t>(ImageType::raw), made_->size());
  }

  // The whole picture, in the server's type unless the request asks for JPEG.
  const ImageType type = request_->kind == ImageRequest::Kind::jpeg ? ImageType::good : desk_.type;
  // Raw: made once for all clients.
  if (type == ImageType::raw) {
    made_ = desk_.make(frame);
    out_ = {asio::const_buffer(), asio::const_buffer(), asio::buffer(*made_)};
    return send(static_cast<std::uint8_t>(type), made_->size());
  }

  // JPEG: the frame's own, or one of another quality encoded once for all clients. Its start is replaced by one with
  // the frame note, whose age is that of this moment.
  std::span<const std::uint8_t> jpeg = frame->image->jpeg;
  if (type != ImageType::good) {
    made_ = desk_.make(frame);
    jpeg = *made_;
  }
  start_ = stamped_start(*frame, age_s(*frame));
  const auto rest = after_start(jpeg);
  out_ = {asio::const_buffer(), asio::buffer(start_), asio::buffer(rest.data(), rest.size())};
  send(static_cast<std::uint8_t>(type), start_.size() + rest.size());
}

void ImageConnection::send_words(const std::string& words) {
  words_until_ = Clock::now() + duration_of(desk_.limits.words_apart_s);
  start_ = words;
  out_ = {asio::const_buffer(), asio::buffer(start_), asio::const_buffer()};
  send(kWords, start_.size());
}

void ImageConnection::send(std::uint8_t type, std::size_t size) {
  look_again_.cancel();
  request_.reset();
  sending_ = true;
  header_ = {type, static_cast<std::uint8_t>(size >> 24 & 0xff), static_cast<std::uint8_t>(size >> 16 & 0xff),
             static_cast<std::uint8_t>(size >> 8 & 0xff), static_cast<std::uint8_t>(size & 0xff)};
  out_[0] = asio::buffer(header_);
  watch_reading();
  const auto after_each_piece = [self = shared_from_this()](error_code error, std::size_t) -> std::size_t {
    if (error) return 0;
    self->watch_reading();
    return kMostAtOnce;
  };
  asio::async_write(socket_, out_, after_each_piece, [self = shared_from_this()](error_code error, std::size_t) {
    self->sending_ = false;
    self->busy_ = Clock::now();
    self->unread_.cancel();
    self->made_.reset();
    self->frame_.reset();
    if (error) return self->close();
    self->asked_ = Clock::now();  // for the request that came meanwhile
    self->look();
  });
}

void ImageConnection::watch_reading() {
  unread_.expires_after(duration_of(desk_.limits.unread_s));
  unread_.async_wait([self = shared_from_this()](error_code cancelled) {
    if (!cancelled) self->close();
  });
}

void ImageConnection::close() {
  if (!open_) return;
  open_ = false;
  std::erase(desk_.readers, this);
  look_again_.cancel();
  unread_.cancel();
  error_code ignored;
  socket_.close(ignored);
}

}  // namespace

Bytes ImageDesk::make(const std::shared_ptr<const Frame>& frame) {
  if (made.size() > 2 * limits.connections) made.clear();  // entries of robots that are gone
  Made& last = made[frame->id];
  if (last.frame == frame) return last.bytes;
  if (type == ImageType::raw) {
    const camera::Picture& picture = frame->image->picture;
    last.bytes = std::make_shared<const std::vector<std::uint8_t>>(raw_picture(
        picture, 0, 0, static_cast<std::uint32_t>(picture.width), static_cast<std::uint32_t>(picture.height)));
  } else {
    const auto jpeg = encoder.encode(frame->image->picture, jpeg_quality(type, 80));
    last.bytes = std::make_shared<const std::vector<std::uint8_t>>(jpeg.begin(), jpeg.end());
  }
  last.frame = frame;  // not earlier: the code above may throw
  return last.bytes;
}

void serve_images(ImageDesk& desk, tcp::socket socket) {
  std::make_shared<ImageConnection>(desk, std::move(socket))->start();
}

}  // namespace kenaf::image_server
