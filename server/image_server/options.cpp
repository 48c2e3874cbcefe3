#include "server/image_server/options.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <stdexcept>

namespace kenaf::image_server {

namespace {

constexpr std::array<std::string_view, 6> kTypeNames{"raw", "superb", "good", "normal", "fair", "bad"};

}  // namespace

void set_cameras(CameraOptions& options, std::string_view text) {
  if (text != "on" && text != "off") throw std::runtime_error(fmt::format("'{}' is neither on nor off", text));
  options.on = text == "on";
}

void set_camera_port(CameraOptions& options, std::string_view text) {
  options.image_server = text != "off";
  if (!options.image_server) return;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), options.image_port);
  if (error != std::errc() || end != text.data() + text.size()) {
    throw std::runtime_error(fmt::format("'{}' is neither a port, 0 to 65535, nor off", text));
  }
}

void set_camera_image(CameraOptions& options, std::string_view text) {
  for (std::size_t i = 0; i < kTypeNames.size(); ++i) {
    if (text != kTypeNames[i]) continue;
    options.image_type = static_cast<ImageType>(i);
    return;
  }
  throw std::runtime_error(fmt::format("'{}' is none of raw, superb, good, normal, fair and bad", text));
}

int jpeg_quality(ImageType type, int own_quality) {
  switch (type) {
    case ImageType::superb:
      return 95;
    case ImageType::normal:
      return 50;
    case ImageType::fair:
      return 25;
    case ImageType::bad:
      return 10;
    case ImageType::good:
    case ImageType::raw:
      break;
  }
  return own_quality;
}

}  // namespace kenaf::image_server
