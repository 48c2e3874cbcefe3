#include "gap/diagnose/channels.hpp"

namespace kenaf::gap {
namespace {

using physics::Stage;

constexpr Channel kAllChannels[] = {{"track_left_mps", "m/s", false, Stage::drive, 1e-3},
                                    {"track_right_mps", "m/s", false, Stage::drive, 1e-3},
                                    {"track_left_m", "m", false, Stage::drive, 1e-3},
                                    {"track_right_m", "m", false, Stage::drive, 1e-3},
                                    {"flipper_fl_rad", "rad", true, Stage::drive, 1e-3},
                                    {"flipper_fr_rad", "rad", true, Stage::drive, 1e-3},
                                    {"flipper_rl_rad", "rad", true, Stage::drive, 1e-3},
                                    {"flipper_rr_rad", "rad", true, Stage::drive, 1e-3},
                                    {"track_left_a", "A", false, Stage::drive, 0.05},
                                    {"track_right_a", "A", false, Stage::drive, 0.05},
                                    {"flipper_fl_a", "A", false, Stage::drive, 0.05},
                                    {"flipper_fr_a", "A", false, Stage::drive, 0.05},
                                    {"flipper_rl_a", "A", false, Stage::drive, 0.05},
                                    {"flipper_rr_a", "A", false, Stage::drive, 0.05},
                                    {"battery_v", "V", false, Stage::drive, 0.02},
                                    {"x_m", "m", false, Stage::body, 5e-4},
                                    {"y_m", "m", false, Stage::body, 5e-4},
                                    {"z_m", "m", false, Stage::body, 5e-4},
                                    {"yaw_rad", "rad", true, Stage::body, 5e-4, true},
                                    {"roll_rad", "rad", true, Stage::sensor, 5e-4, true},
                                    {"pitch_rad", "rad", true, Stage::sensor, 5e-4},
                                    {"gyro_x_radps", "rad/s", false, Stage::sensor, 2e-3},
                                    {"gyro_y_radps", "rad/s", false, Stage::sensor, 2e-3},
                                    {"gyro_z_radps", "rad/s", false, Stage::sensor, 2e-3}};

}  // namespace

std::span<const Channel> diagnosis_channels() {
  return kAllChannels;
}

}  // namespace kenaf::gap
