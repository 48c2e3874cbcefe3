#include "server/image_server/options.hpp"

#include <array>
#include <optional>
#include <stdexcept>

#include "formats/settings/nearest_word.hpp"
#include "formats/settings/numbers.hpp"

namespace kenaf::image_server {

namespace {

const std::array<std::string, 6> kTypeNames{"raw", "superb", "good", "normal", "fair", "bad"};

}  // namespace

void set_cameras(CameraOptions& options, std::string_view text) {
  if (text != "on" && text != "off") throw std::runtime_error("must be on or off");
  options.on = text == "on";
}

void set_camera_port(CameraOptions& options, std::string_view text) {
  options.image_server = text != "off";
  if (!options.image_server) return;
  const std::optional<std::uint64_t> port = settings::whole_number_from(text);
  if (!port || *port > 65535) throw std::runtime_error("must be a port from 0 to 65535, or off");
  options.image_port = static_cast<std::uint16_t>(*port);
}

void set_camera_image(CameraOptions& options, std::string_view text) {
  for (std::size_t i = 0; i < kTypeNames.size(); ++i) {
    if (text != kTypeNames[i]) continue;
    options.image_type = static_cast<ImageType>(i);
    return;
  }
  throw std::runtime_error("must be " + settings::either_of(kTypeNames) + settings::did_you_mean(text, kTypeNames));
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
