// hrt_get_picture after its argument checks.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "hrt/camera_stream.hpp"
#include "hrt/robot.hpp"
#include "kenaf/hrt.h"

namespace kenaf::hrt {

// Fills `picture` (all but its size member) and `data` as hrt.h specifies. `format` is one of HRT_PICTURE_... . Throws
// Error.
void get_picture(Robot& robot, Cameras& cameras, const std::string& camera, int format, std::span<std::uint8_t> data,
                 double timeout_s, hrt_picture& picture);

}  // namespace kenaf::hrt
