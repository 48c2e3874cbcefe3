#include "server/live/viewer.hpp"

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>

#include "server/live/messages.hpp"
#include "server/live/request.hpp"
#include "server/live/requests_to_world.hpp"
#include "server/world_server/manual_drive.hpp"

namespace kenaf::live {

namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using beast::error_code;
using Clock = std::chrono::steady_clock;

// System buffer for unread states; the larger, the older the states on a slow page.
constexpr int kSendBuffer_bytes = 65536;

class OpenViewer final : public Viewer, public std::enable_shared_from_this<OpenViewer> {
 public:
  OpenViewer(Hub& hub, beast::tcp_stream stream)
      : hub_(hub), who_{++hub.last_operator}, socket_(std::move(stream)), pause_(hub.site.io) {
    ++hub_.site.connections;
  }
  ~OpenViewer() {
    std::erase(hub_.viewers, this);  // it may end by an exception
    --hub_.site.connections;
  }
  OpenViewer(const OpenViewer&) = delete;
  OpenViewer& operator=(const OpenViewer&) = delete;

  void start(const PageRequest& upgrade);
  void show(const Message& state) override {
    state_ = state;
    write();
  }
  void tell(const Message& message) override;
  const ShowRequest& shown() const override { return shown_; }

 private:
  void welcome();
  void read();
  void take(std::string_view text);
  void read_again();
  void write();
  void close();
  void tell(std::string text) { tell(std::make_shared<const std::string>(std::move(text))); }

  Hub& hub_;
  const world_server::OperatorId who_;
  websocket::stream<beast::tcp_stream> socket_;
  boost::asio::steady_timer pause_;
  beast::flat_buffer received_;
  std::deque<Message> answers_;
  Message state_, sending_;
  ShowRequest shown_;
  bool open_ = false;
  Clock::time_point second_began_ = Clock::now();
  int requests_ = 0;  // in this second
};

void OpenViewer::start(const PageRequest& upgrade) {
  error_code ignored;
  auto& tcp = beast::get_lowest_layer(socket_);
  tcp.socket().set_option(boost::asio::socket_base::send_buffer_size(kSendBuffer_bytes), ignored);
  tcp.socket().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
  tcp.expires_never();  // the WebSocket has its own time-outs
  const auto quiet =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(hub_.site.limits.quiet_s));
  socket_.set_option(websocket::stream_base::timeout{quiet, quiet, true});
  socket_.read_message_max(hub_.limits.message_bytes);
  socket_.text(true);
  socket_.async_accept(upgrade, [self = shared_from_this()](error_code error) {
    if (!error) self->welcome();
  });
}

void OpenViewer::welcome() {
  if (hub_.viewers.size() >= hub_.limits.viewers) return;  // others were faster
  open_ = true;
  hub_.viewers.push_back(this);
  const auto& world = hub_.world;
  tell(hello_message(who_, hub_.server_number, world.world_description().name, world.time_step_s(),
                     world_server::kOperatorSilence_s, hub_.cameras != nullptr));
  if (hub_.inventory) tell(hub_.inventory);
  hub_.viewer_came();
  read();
}

void OpenViewer::read() {
  socket_.async_read(received_, [self = shared_from_this()](error_code error, std::size_t) {
    if (error || !self->open_) return self->close();
    const auto bytes = self->received_.cdata();
    self->take({static_cast<const char*>(bytes.data()), bytes.size()});
  });
}

// The next request is read when this one is done, so a viewer has one request under way, and no queue grows.
void OpenViewer::take(std::string_view text) {
  const auto parsed = parse_request(text);
  received_.clear();
  if (const auto* wrong = std::get_if<std::string>(&parsed)) {
    tell(refused_message("", *wrong));
    return read_again();
  }
  const Request& request = std::get<Request>(parsed);
  if (const auto* ping = std::get_if<PingRequest>(&request)) {
    tell(pong_message(ping->t));
    return read_again();
  }
  if (const auto* show = std::get_if<ShowRequest>(&request)) {
    shown_ = *show;
    return read_again();
  }
  hub_.ask([request, who = who_](world_server::Simulation& simulation) { return carry_out(simulation, who, request); },
           [self = shared_from_this()](const std::string& answer) {
             if (!answer.empty()) self->tell(std::string(answer));
             self->read_again();
           });
}

void OpenViewer::read_again() {
  if (!open_) return;
  const Clock::time_point now = Clock::now();
  if (now - second_began_ >= std::chrono::seconds(1)) {
    second_began_ = now;
    requests_ = 0;
  }
  if (++requests_ < hub_.limits.requests_per_s) return read();
  pause_.expires_at(second_began_ + std::chrono::seconds(1));
  pause_.async_wait([self = shared_from_this()](error_code) {
    if (self->open_) self->read();
  });
}

void OpenViewer::tell(const Message& message) {
  if (!open_) return;
  if (answers_.size() >= hub_.limits.unread_answers) return close();
  answers_.push_back(message);
  write();
}

void OpenViewer::write() {
  if (!open_ || sending_) return;
  if (!answers_.empty()) {
    sending_ = std::move(answers_.front());
    answers_.pop_front();
  } else {
    sending_ = std::move(state_);
    state_ = nullptr;
  }
  if (!sending_) return;
  socket_.async_write(boost::asio::buffer(*sending_), [self = shared_from_this()](error_code error, std::size_t) {
    self->sending_ = nullptr;
    if (error) return self->close();
    self->write();
  });
}

void OpenViewer::close() {
  if (!open_) return;
  open_ = false;
  std::erase(hub_.viewers, this);
  answers_.clear();
  state_ = nullptr;
  pause_.cancel();
  hub_.world.ask([who = who_](world_server::Simulation& simulation) { world_server::let_go_of_all(simulation, who); });
  error_code ignored;
  beast::get_lowest_layer(socket_).socket().close(ignored);
}

}  // namespace

void start_viewer(Hub& hub, beast::tcp_stream stream, PageRequest upgrade) {
  std::make_shared<OpenViewer>(hub, std::move(stream))->start(std::move(upgrade));
}

}  // namespace kenaf::live
