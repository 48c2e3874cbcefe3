// A camera of the simulated robot: TCP to the world server's image port and back. formats/protocol/image_message.hpp
// has the wire format.
//
// One request is under way at a time, so a picture is requested only when it is needed, and none ages in a buffer.
// USARSim image servers that know neither 'J' nor frame notes are supported: if the first 'J' stays unanswered for a
// second, 'OK' is sent from then on; pictures are then counted here, and their age and robot time are unknown.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "formats/protocol/image_message.hpp"
#include "hrt/camera.hpp"
#include "kenaf/hrt.h"
#include "libkenaf_sim/addresses.hpp"

namespace kenaf::sim {

class ImageClient final : public hrt::Camera {
 public:
  // `camera`: "ROBOT/CAMERA", "CAMERA" of the robot placed last, or "": the server's choice, its robot's first camera.
  ImageClient(const hrt_config& config, const std::string& camera, AskForAddresses ask = ask_system);
  ~ImageClient() override;
  ImageClient(const ImageClient&) = delete;
  ImageClient& operator=(const ImageClient&) = delete;

  void open() override;
  std::optional<hrt::CameraPicture> next() override;
  void pause() override {}  // nothing is under way between two calls of next()
  void interrupt() override;

 private:
  using Clock = std::chrono::steady_clock;
  enum class Ready { yes, time_is_up, interrupted };

  Ready wait_for(short events, Clock::time_point until) const;
  void request();
  void send_all(std::string_view bytes);
  // Waits for an answer and reads it. Returns false if interrupted.
  bool read_answer();
  // Returns false if the connection has no more data for now.
  bool receive_some();
  [[noreturn]] void lose(const std::string& why) const;
  hrt::CameraPicture picture_of_answer();

  // Returns 0, or the errno of the failed connection; nullopt: interrupted.
  std::optional<int> connect_to(const Address& address, Clock::time_point until);

  std::string server_, camera_;
  AskForAddresses ask_;
  std::chrono::duration<double> patience_,
      silence_;  // with a connection that is being made; with one that says nothing
  int socket_ = -1, interrupt_ = -1;
  bool is_old_server_ = false;                       // it understands only 'OK'
  bool is_kenaf_server_ = false;                     // it has sent a frame note
  Clock::time_point requested_at_{}, request_at_{};  // the last one; the next one, not earlier
  Clock::time_point newest_at_ = Clock::now();
  std::uint64_t newest_number_ = 0;
  std::uint64_t counted_ = 0;  // number of pictures without a frame note
  protocol::image::AnswerReader reader_;
  std::array<std::uint8_t, 65536> buffer_{};
  std::span<const std::uint8_t> unread_{};  // part of buffer_
};

}  // namespace kenaf::sim
