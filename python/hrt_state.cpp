// hrt_state as a class of read-only attributes, of which those not measured are NaN.
#include <pybind11/numpy.h>

#include <limits>

#include "python/hrt.hpp"

namespace kenaf::python {
namespace py = pybind11;
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint32_t kAlways = 0;  // a member that is no measurement

bool is_known(const hrt_state& state, std::uint32_t bit) {
  return bit == kAlways || (state.valid & bit) != 0;
}

void add_number(py::class_<hrt_state>& type, const char* name, double hrt_state::*member, std::uint32_t bit = kAlways) {
  type.def_property_readonly(
      name, [member, bit](const hrt_state& state) { return is_known(state, bit) ? state.*member : kNan; });
}

template <std::size_t size>
void add_array(py::class_<hrt_state>& type, const char* name, double (hrt_state::*member)[size],
               std::uint32_t bit = kAlways) {
  type.def_property_readonly(name, [member, bit](const hrt_state& state) {
    py::array_t<double> array(size);
    for (std::size_t i = 0; i < size; ++i) array.mutable_at(i) = is_known(state, bit) ? (state.*member)[i] : kNan;
    return array;
  });
}

}  // namespace

void add_state(py::module_& module) {
  py::class_<hrt_state> type(module, "State", py::module_local(),
                             "State of the robot as of one cycle: the members of hrt_state, with its units.\n\n"
                             "Arrays are float64: track_* of shape (2,), flipper_* (4,), gyro and acceleration (3,).\n"
                             "A member that was not measured is NaN, where hrt_state has 0.");
  type.def_readonly("valid", &hrt_state::valid);
  type.def_readonly("activity", &hrt_state::activity);
  type.def_readonly("flippers_commanded", &hrt_state::flippers_commanded);
  type.def_readonly("cycle", &hrt_state::cycle);
  type.def_readonly("late_cycles", &hrt_state::late_cycles);
  type.def_readonly("lost_cycles", &hrt_state::lost_cycles);
  add_number(type, "time_s", &hrt_state::time_s);
  add_number(type, "roll_deg", &hrt_state::roll_deg, HRT_HAS_POSTURE);
  add_number(type, "pitch_deg", &hrt_state::pitch_deg, HRT_HAS_POSTURE);
  add_number(type, "yaw_deg", &hrt_state::yaw_deg, HRT_HAS_POSTURE);
  add_array(type, "gyro_degps", &hrt_state::gyro_degps, HRT_HAS_INERTIAL);
  add_array(type, "acceleration_mmps2", &hrt_state::acceleration_mmps2, HRT_HAS_INERTIAL);
  add_array(type, "track_mm", &hrt_state::track_mm, HRT_HAS_ENCODERS);
  add_array(type, "track_mmps", &hrt_state::track_mmps, HRT_HAS_ENCODERS);
  add_array(type, "track_a", &hrt_state::track_a, HRT_HAS_CURRENTS);
  add_array(type, "flipper_deg", &hrt_state::flipper_deg, HRT_HAS_FLIPPERS);
  add_array(type, "flipper_a", &hrt_state::flipper_a, HRT_HAS_CURRENTS);
  add_number(type, "battery_v", &hrt_state::battery_v, HRT_HAS_BATTERY);
  add_number(type, "odometry_x_mm", &hrt_state::odometry_x_mm, HRT_HAS_ENCODERS);
  add_number(type, "odometry_y_mm", &hrt_state::odometry_y_mm, HRT_HAS_ENCODERS);
  add_number(type, "odometry_yaw_deg", &hrt_state::odometry_yaw_deg, HRT_HAS_ENCODERS);
  add_number(type, "pose_x_mm", &hrt_state::pose_x_mm, HRT_HAS_POSE);
  add_number(type, "pose_y_mm", &hrt_state::pose_y_mm, HRT_HAS_POSE);
  add_number(type, "pose_z_mm", &hrt_state::pose_z_mm, HRT_HAS_POSE);
  add_number(type, "pose_roll_deg", &hrt_state::pose_roll_deg, HRT_HAS_POSE);
  add_number(type, "pose_pitch_deg", &hrt_state::pose_pitch_deg, HRT_HAS_POSE);
  add_number(type, "pose_yaw_deg", &hrt_state::pose_yaw_deg, HRT_HAS_POSE);
  add_array(type, "commanded_track_mmps", &hrt_state::commanded_track_mmps);
  add_array(type, "commanded_flipper_deg", &hrt_state::commanded_flipper_deg);
  add_number(type, "round_trip_ms", &hrt_state::round_trip_ms);
}

}  // namespace kenaf::python
