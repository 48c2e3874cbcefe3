// hrt_config as a class with attributes.
#include <pybind11/stl.h>

#include <cstring>
#include <stdexcept>
#include <string>

#include "python/hrt.hpp"

namespace kenaf::python {
namespace py = pybind11;
namespace {

template <std::size_t size>
void add_text(py::class_<hrt_config>& type, const char* name, char (hrt_config::*member)[size]) {
  type.def_property(
      name, [member](const hrt_config& config) { return std::string(config.*member); },
      [name, member](hrt_config& config, const std::string& text) {
        if (text.size() >= size || text.find('\0') != std::string::npos)
          throw py::value_error(std::string(name) + ": has at most " + std::to_string(size - 1) +
                                " bytes, none of them 0");
        std::memcpy(config.*member, text.c_str(), text.size() + 1);
      });
}

hrt_config config_with(const py::kwargs& members) {
  const hrt_config defaults = hrt_config_default();
  const py::object config = py::cast(defaults);
  for (const auto& [name, value] : members) {
    if (!py::hasattr(config, name)) throw py::type_error("hrt_config has no member " + name.cast<std::string>());
    py::setattr(config, name, value);
  }
  return config.cast<hrt_config>();
}

}  // namespace

void add_config(py::module_& module) {
  py::class_<hrt_config> type(module, "Config", py::module_local(),
                              "Configuration: the members of hrt_config, with its units and ranges.\n\n"
                              "Config(max_speed_mmps=100) has the defaults built into the library for all others.");
  type.def(py::init(&config_with));
  const auto add = [&type](const char* name, auto member) { type.def_readwrite(name, member); };
  add("period_s", &hrt_config::period_s);
  add("command_timeout_s", &hrt_config::command_timeout_s);
  add("link_timeout_s", &hrt_config::link_timeout_s);
  add("connect_timeout_s", &hrt_config::connect_timeout_s);
  add("max_speed_mmps", &hrt_config::max_speed_mmps);
  add("acceleration_mmps2", &hrt_config::acceleration_mmps2);
  add("max_turn_degps", &hrt_config::max_turn_degps);
  add("turn_acceleration_degps2", &hrt_config::turn_acceleration_degps2);
  add("distance_tolerance_mm", &hrt_config::distance_tolerance_mm);
  add("angle_tolerance_deg", &hrt_config::angle_tolerance_deg);
  add("stuck_time_s", &hrt_config::stuck_time_s);
  add("stuck_current_a", &hrt_config::stuck_current_a);
  add("track_gauge_mm", &hrt_config::track_gauge_mm);
  add("turn_efficiency", &hrt_config::turn_efficiency);
  add("hold_s", &hrt_config::hold_s);
  add("lockstep", &hrt_config::lockstep);
  add("reset_robot", &hrt_config::reset_robot);
  add("can_timeout_s", &hrt_config::can_timeout_s);
  add_text(type, "relay", &hrt_config::relay);
  add_text(type, "can_interface", &hrt_config::can_interface);
  add_text(type, "robot", &hrt_config::robot);
  add_text(type, "record", &hrt_config::record);
  add_text(type, "camera_server", &hrt_config::camera_server);
  type.def(
      "load", [](hrt_config& config) { call(hrt_config_load, &config); },
      "Overrides members by the configuration file and the environment, as hrt_config_load does.\n\n"
      "Raises ConfigError, which names file, line and column or the variable.");
}

}  // namespace kenaf::python
