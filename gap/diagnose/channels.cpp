#include "gap/diagnose/channels.hpp"

#include <iterator>

namespace kenaf::gap {
namespace {

using physics::Stage;

constexpr Channel kAllChannels[] = {{"track_left_mps", "m/s", false, Stage::drive, 1e-3, "track speed"},
                                    {"track_right_mps", "m/s", false, Stage::drive, 1e-3, "track speed"},
                                    {"track_left_m", "m", false, Stage::drive, 1e-3, "track travel"},
                                    {"track_right_m", "m", false, Stage::drive, 1e-3, "track travel"},
                                    {"flipper_fl_rad", "rad", true, Stage::drive, 1e-3, "flipper angle"},
                                    {"flipper_fr_rad", "rad", true, Stage::drive, 1e-3, "flipper angle"},
                                    {"flipper_rl_rad", "rad", true, Stage::drive, 1e-3, "flipper angle"},
                                    {"flipper_rr_rad", "rad", true, Stage::drive, 1e-3, "flipper angle"},
                                    {"track_left_a", "A", false, Stage::drive, 0.05, "track current"},
                                    {"track_right_a", "A", false, Stage::drive, 0.05, "track current"},
                                    {"flipper_fl_a", "A", false, Stage::drive, 0.05, "flipper current"},
                                    {"flipper_fr_a", "A", false, Stage::drive, 0.05, "flipper current"},
                                    {"flipper_rl_a", "A", false, Stage::drive, 0.05, "flipper current"},
                                    {"flipper_rr_a", "A", false, Stage::drive, 0.05, "flipper current"},
                                    {"battery_v", "V", false, Stage::drive, 0.02, "battery voltage"},
                                    {"x_m", "m", false, Stage::body, 5e-4, "position"},
                                    {"y_m", "m", false, Stage::body, 5e-4, "position"},
                                    {"z_m", "m", false, Stage::body, 5e-4, "height"},
                                    {"yaw_rad", "rad", true, Stage::body, 5e-4, "yaw", true},
                                    {"roll_rad", "rad", true, Stage::sensor, 5e-4, "roll", true},
                                    {"pitch_rad", "rad", true, Stage::sensor, 5e-4, "pitch"},
                                    {"gyro_x_radps", "rad/s", false, Stage::sensor, 2e-3, "roll rate"},
                                    {"gyro_y_radps", "rad/s", false, Stage::sensor, 2e-3, "pitch rate"},
                                    {"gyro_z_radps", "rad/s", false, Stage::sensor, 2e-3, "yaw rate"}};

}  // namespace

std::span<const Channel> diagnosis_channels() {
  return kAllChannels;
}

std::size_t kind_of(std::size_t channel) {
  std::size_t kind = 0;
  for (std::size_t c = 1; c <= channel; ++c)
    if (kAllChannels[c].kind != kAllChannels[c - 1].kind) ++kind;
  return kind;
}

std::string_view kind_name(std::size_t kind) {
  std::size_t channel = 0;
  while (kind_of(channel) != kind) ++channel;
  return kAllChannels[channel].kind;
}

std::size_t kind_count() {
  return kind_of(std::size(kAllChannels) - 1) + 1;
}

}  // namespace kenaf::gap
