// The modules kenaf.hrt_sim and kenaf.hrt_real. The names are those of hrt.h without hrt_ and HRT_.
#include <pybind11/stl.h>

#include <array>
#include <optional>
#include <string>

#include "python/hrt.hpp"
#include "python/hrt_interrupt.hpp"

namespace kenaf::python {
namespace py = pybind11;
namespace {

constexpr std::size_t kMostWarning = 4096;

struct Session {};  // the robot of this process, open

void close_robot() {
  raise_unless_ok(without_gil(hrt_close));
}

// A signal does not end an opening. Whoever gets its exception gets no robot, which nobody would close.
void kenaf_init(const std::optional<hrt_config>& config) {
  const int result = config ? interruptible(hrt_kenaf_init_with, &*config) : interruptible(hrt_kenaf_init);
  try {
    handle_signals();
  } catch (const py::error_already_set&) {
    if (result == HRT_OK) (void)without_gil(hrt_close);
    throw;
  }
  raise_unless_ok(result);
}

hrt_state get_state() {
  hrt_state state = hrt_state_init();
  call(hrt_get_state, &state);
  return state;
}

hrt_state wait_cycle() {
  hrt_state state = hrt_state_init();
  call_blocking(hrt_wait_cycle, &state);
  return state;
}

std::string get_warning() {
  std::array<char, kMostWarning> text{};
  call(hrt_get_warning, text.data(), text.size());
  return text.data();
}

std::string get_setup() {
  std::array<char, kMostWarning> text{};
  call(hrt_get_setup, text.data(), text.size());
  return text.data();
}

// Stops the robot whatever ends the block; an error of closing does not hide one of the block.
bool exit_session(const py::object&, const py::object& raised, const py::object&, const py::object&) {
  try {
    close_robot();
  } catch (const py::error_already_set&) {
    if (raised.is_none()) throw;
  }
  return false;
}

void add_constants(py::module_& module) {
  const auto add = [&module](const char* name, int value) { module.attr(name) = value; };
  add("FRONT_LEFT", HRT_FRONT_LEFT);
  add("FRONT_RIGHT", HRT_FRONT_RIGHT);
  add("REAR_LEFT", HRT_REAR_LEFT);
  add("REAR_RIGHT", HRT_REAR_RIGHT);
  add("ALL_FLIPPERS", HRT_ALL_FLIPPERS);
  add("LEFT", HRT_LEFT);
  add("RIGHT", HRT_RIGHT);
  add("HAS_POSTURE", HRT_HAS_POSTURE);
  add("HAS_ENCODERS", HRT_HAS_ENCODERS);
  add("HAS_FLIPPERS", HRT_HAS_FLIPPERS);
  add("HAS_CURRENTS", HRT_HAS_CURRENTS);
  add("HAS_BATTERY", HRT_HAS_BATTERY);
  add("HAS_INERTIAL", HRT_HAS_INERTIAL);
  add("HAS_POSE", HRT_HAS_POSE);
  add("MOTION_ACTIVE", HRT_MOTION_ACTIVE);
  add("PAUSED", HRT_PAUSED);
  add("STOPPED_BY_SILENCE", HRT_STOPPED_BY_SILENCE);
  add("RECORDING", HRT_RECORDING);
  add("IN_LOCKSTEP", HRT_IN_LOCKSTEP);
  add("DEGRADED", HRT_DEGRADED);
}

void add_beginning_and_end(py::module_& module) {
  module.def("kenaf_init", &kenaf_init, py::arg("config") = py::none(),
             "Opens the robot and waits for its first state.\n\n"
             "config: a Config; None: by configuration file and environment. Raises LinkError if there is nothing to\n"
             "drive (the text says what to start), RefusedError if another program has the robot, ConfigError.");
  module.def("close", &close_robot, "Stops the tracks, ends a recording, and releases the robot.");
  py::class_<Session>(module, "Session", py::module_local(),
                      "The robot for the time of a with block: kenaf_init() at its beginning, close() at its end.\n\n"
                      "    with hrt.Session():\n"
                      "        hrt.go_forward(100)")
      .def(py::init([](const std::optional<hrt_config>& config) {
             kenaf_init(config);
             return Session();
           }),
           py::arg("config") = py::none())
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", &exit_session);
}

void add_motions(py::module_& module) {
  module.def(
      "go_forward", [](double mm) { call_blocking(hrt_go_forward, mm); }, py::arg("mm"),
      "Drives straight forward (negative: backward) by `mm` millimetres; blocks until the robot stands.\n\n"
      "Raises StuckError, TimeoutError, StoppedError, LinkError; the tracks are stopped then.");
  module.def(
      "turning", [](double deg) { call_blocking(hrt_turning, deg); }, py::arg("deg"),
      "Turns in place by `deg` degrees to the left (negative: to the right); blocks until the robot stands.\n\n"
      "Raises as go_forward.");
  module.def(
      "set_tracks", [](double left, double right) { call(hrt_set_tracks, left, right); }, py::arg("left_mmps"),
      py::arg("right_mmps"),
      "Commands both tracks' speeds in mm/s, until changed or until command_timeout_s after the last call.");
  module.def(
      "set_flipper", [](int flipper, double deg) { call(hrt_set_flipper, flipper, deg); }, py::arg("flipper"),
      py::arg("deg"),
      "Commands one flipper, or ALL_FLIPPERS, to an angle in degrees: 0 straight out, positive tip up.");
  module.def(
      "set_flippers",
      [](double front_left, double front_right, double rear_left, double rear_right) {
        call(hrt_set_flippers, front_left, front_right, rear_left, rear_right);
      },
      py::arg("front_left_deg"), py::arg("front_right_deg"), py::arg("rear_left_deg"), py::arg("rear_right_deg"),
      "Commands all four flippers at once.");
  module.def(
      "stop", [] { call(hrt_stop); }, "Stops tracks and flippers; a motion of another thread raises StoppedError.");
}

void add_waiting(py::module_& module) {
  module.def(
      "wait_flippers",
      [](double tolerance_deg, double timeout_s) { call_blocking(hrt_wait_flippers, tolerance_deg, timeout_s); },
      py::arg("tolerance_deg"), py::arg("timeout_s"),
      "Waits until all commanded flippers are within `tolerance_deg`; raises TimeoutError after `timeout_s` of robot "
      "time.");
  module.def("sleep", &sleep_interruptibly, py::arg("seconds"), "Waits `seconds` of robot time.");
  module.def("time", &hrt_time, "Returns robot time in seconds; -1 if no robot is open.");
  module.def("wait_cycle", &wait_cycle, "Waits for the next cycle and returns its State: the clock of a control loop.");
}

void add_state_and_recording(py::module_& module) {
  module.def("get_state", &get_state, "Returns the newest State. Does not block.");
  module.def("get_setup", &get_setup,
             "Returns how init() has set the robot up, in lines; \"\" if there is nothing to say.");
  module.def("get_warning", &get_warning, "Returns what is missing on the robot, one line; \"\" if nothing is.");
  module.def(
      "record_start", [](const std::string& path) { call(hrt_record_start, path.c_str()); }, py::arg("path"),
      "Records every cycle from now on into a CSV file that kenaf.read_run() reads.");
  module.def(
      "record_stop", [] { call_blocking(hrt_record_stop); }, "Ends the recording; the file is complete then.");
  module.def("version", &hrt_version, "Returns the library's version.");
  module.def("library", &hrt_library, "Returns \"real\" or \"sim\".");
}

}  // namespace

void add_all(py::module_& module) {
  module.doc() =
      "Control of the Kenaf robot: hrt.h for Python, with its units: millimetres, degrees, seconds.\n\n"
      "Names are those of hrt.h without hrt_ and HRT_. A function that fails raises a subclass of Error. Blocking "
      "calls\n"
      "let other threads run. Control-C stops a motion and the tracks, and raises KeyboardInterrupt.";
  add_errors(module);
  add_constants(module);
  add_config(module);
  add_state(module);
  add_beginning_and_end(module);
  add_motions(module);
  add_waiting(module);
  add_state_and_recording(module);
  add_pictures(module);
}

}  // namespace kenaf::python

PYBIND11_MODULE(KENAF_HRT_MODULE, module) {
  kenaf::python::add_all(module);
}
