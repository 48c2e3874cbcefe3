#include "server/live/picture_stream.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>

#include "server/live/access.hpp"
#include "server/live/headers.hpp"

namespace kenaf::live {

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;
using FramePtr = std::shared_ptr<const image_server::Frame>;

constexpr std::string_view kBoundary = "kenaf-frame";
// System buffer for unread pictures; the larger, the older the pictures in a slow browser.
constexpr int kUnreadPictures_bytes = 131072;
// Period at which a waiting picture's camera is requested.
constexpr std::chrono::milliseconds kAskAgain{250};
constexpr std::chrono::seconds kRepeat{1}, kLongestWait{10};

int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string without_escapes(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape =
        text[i] == '%' && i + 2 < text.size() && hexadecimal(text[i + 1]) >= 0 && hexadecimal(text[i + 2]) >= 0;
    out += escape ? static_cast<char>(16 * hexadecimal(text[i + 1]) + hexadecimal(text[i + 2])) : text[i];
    if (escape) i += 2;
  }
  return out;
}

class PictureConnection final : public PictureReader, public std::enable_shared_from_this<PictureConnection> {
 public:
  PictureConnection(Hub& hub, image_server::Feed& cameras, tcp::socket socket, PicturePath path)
      : hub_(hub),
        cameras_(cameras),
        socket_(std::move(socket)),
        path_(std::move(path)),
        ask_again_(hub.site.io),
        unread_(hub.site.io) {
    ++hub_.site.connections;
  }
  ~PictureConnection() {
    std::erase(hub_.picture_readers, this);  // it may end by an exception
    --hub_.site.connections;
  }
  PictureConnection(const PictureConnection&) = delete;
  PictureConnection& operator=(const PictureConnection&) = delete;

  void start();
  void look() override;

 private:
  void watch_for_end();
  void send(const FramePtr& frame);
  void refuse(std::string_view status, const std::string& words);
  void write(bool then_close);
  void look_later();
  void watch_progress();
  void close();

  Hub& hub_;
  image_server::Feed& cameras_;
  tcp::socket socket_;
  const PicturePath path_;
  asio::steady_timer ask_again_, unread_;
  std::array<char, 512> received_;
  Clock::time_point asked_ = Clock::now();
  FramePtr frame_;  // the last one sent, or being sent
  bool begun_ = false, sending_ = false, open_ = true;
  std::string head_, tail_;
  std::array<asio::const_buffer, 3> out_;
};

void PictureConnection::start() {
  hub_.picture_readers.push_back(this);
  error_code ignored;
  socket_.set_option(tcp::no_delay(true), ignored);
  socket_.set_option(asio::socket_base::send_buffer_size(kUnreadPictures_bytes), ignored);
  watch_for_end();
  look();
}

// Further input is discarded; only the end of the connection matters.
void PictureConnection::watch_for_end() {
  socket_.async_read_some(asio::buffer(received_), [self = shared_from_this()](error_code error, std::size_t) {
    if (!self->open_) return;
    if (error) return self->close();
    self->watch_for_end();
  });
}

void PictureConnection::look() {
  if (!open_ || sending_) return;
  const image_server::Feed::Look seen = cameras_.look(path_.view, path_.size);
  if (!seen.none.empty()) return begun_ ? close() : refuse("404 Not Found", seen.none);
  const Clock::duration waited = Clock::now() - asked_;
  if (seen.frame && (seen.frame != frame_ || waited >= kRepeat)) return send(seen.frame);
  if (!seen.frame && waited >= kLongestWait) {
    return begun_ ? close() : refuse("503 Service Unavailable", "there is no picture yet");
  }
  look_later();
}

void PictureConnection::look_later() {
  ask_again_.expires_after(kAskAgain);
  ask_again_.async_wait([self = shared_from_this()](error_code cancelled) {
    if (!cancelled) self->look();
  });
}

void PictureConnection::send(const FramePtr& frame) {
  frame_ = frame;
  const double age_s = image_server::age_s(*frame);
  const std::string start = image_server::stamped_start(*frame, age_s);
  const auto rest = image_server::after_start(frame->image->jpeg);
  const std::string about = fmt::format(
      "Content-Type: image/jpeg\r\nContent-Length: {}\r\nX-Frame-Number: {}\r\nX-Robot-Time: {:.6f}\r\nX-Age-Ms: "
      "{:.3f}\r\n",
      start.size() + rest.size(), frame->number, frame->robot_time_s, 1e3 * age_s);
  head_.clear();
  tail_.clear();
  if (!path_.stream) {
    head_ = fmt::format("HTTP/1.1 200 OK\r\n{}Cache-Control: no-store\r\n{}Connection: close\r\n\r\n", about,
                        safety_headers());
  } else {
    if (!begun_) {
      head_ = fmt::format(
          "HTTP/1.1 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary={}\r\nCache-Control: no-store\r\n{}"
          "Connection: close\r\n\r\n--{}\r\n",
          kBoundary, safety_headers(), kBoundary);
    }
    head_ += about + "\r\n";
    // browsers show a part once they have seen its end
    tail_ = fmt::format("\r\n--{}\r\n", kBoundary);
  }
  head_ += start;
  begun_ = true;
  out_ = {asio::buffer(head_), asio::buffer(rest.data(), rest.size()), asio::buffer(tail_)};
  write(!path_.stream);
}

void PictureConnection::refuse(std::string_view status, const std::string& words) {
  begun_ = true;
  head_ = fmt::format(
      "HTTP/1.1 {}\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: {}\r\nCache-Control: no-store\r\n{}"
      "Connection: close\r\n\r\n{}\n",
      status, words.size() + 1, safety_headers(), words);
  out_ = {asio::buffer(head_), asio::const_buffer(), asio::const_buffer()};
  write(true);
}

void PictureConnection::write(bool then_close) {
  ask_again_.cancel();
  sending_ = true;
  watch_progress();
  const auto after_each_piece = [self = shared_from_this()](error_code error, std::size_t) -> std::size_t {
    if (error) return 0;
    self->watch_progress();
    return std::size_t{1} << 20;
  };
  asio::async_write(socket_, out_, after_each_piece,
                    [self = shared_from_this(), then_close](error_code error, std::size_t) {
                      self->sending_ = false;
                      self->unread_.cancel();
                      if (error) return self->close();
                      if (then_close) {
                        self->sending_ = true;  // nothing more; the browser closes
                        self->watch_progress();
                        self->socket_.shutdown(tcp::socket::shutdown_send, error);
                        return;
                      }
                      self->asked_ = Clock::now();
                      self->look();
                    });
}

void PictureConnection::watch_progress() {
  unread_.expires_after(
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(hub_.limits.quiet_s)));
  unread_.async_wait([self = shared_from_this()](error_code cancelled) {
    if (!cancelled) self->close();
  });
}

void PictureConnection::close() {
  if (!open_) return;
  open_ = false;
  std::erase(hub_.picture_readers, this);
  ask_again_.cancel();
  unread_.cancel();
  error_code ignored;
  socket_.close(ignored);
}

}  // namespace

std::optional<PicturePath> parse_picture_path(std::string_view path, std::string_view query) {
  constexpr std::string_view kStream = ".mjpg", kPicture = ".jpg";
  if (!path.starts_with('/')) return std::nullopt;
  path.remove_prefix(1);
  const bool stream = path.ends_with(kStream);
  if (!stream && !path.ends_with(kPicture)) return std::nullopt;
  path.remove_suffix(stream ? kStream.size() : kPicture.size());
  if (path.empty()) return std::nullopt;
  const std::string_view size = query_value(query, "size");
  if (!size.empty() && size != "full" && size != "half") return std::nullopt;
  using enum image_server::PictureSize;
  return PicturePath{without_escapes(path), stream, size == "half" ? half : full};
}

void start_pictures(Hub& hub, image_server::Feed& cameras, boost::beast::tcp_stream stream, const PicturePath& path) {
  std::make_shared<PictureConnection>(hub, cameras, stream.release_socket(), path)->start();
}

}  // namespace kenaf::live
