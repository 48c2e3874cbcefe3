// Pictures of the robot's cameras, as arrays or JPEG files.
#include <pybind11/numpy.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "python/hrt.hpp"
#include "python/hrt_interrupt.hpp"

namespace kenaf::python {
namespace py = pybind11;
namespace {

constexpr double kLongest_s = 60;  // of hrt_get_picture
constexpr std::size_t kFirstGuess = std::size_t{640} * 480 * 3;
constexpr double kPart_s = 0.1;  // of a wait, between which signals are handled
constexpr int kTries = 5;        // a camera that grows its pictures between all of them does not exist

struct Picture {
  hrt_picture properties;
  py::object data;  // an array of shape (height, width, 3), or bytes
};

py::object data_of(const hrt_picture& picture, const std::vector<unsigned char>& bytes) {
  if (picture.format == HRT_PICTURE_JPEG) return py::bytes(reinterpret_cast<const char*>(bytes.data()), picture.bytes);
  return py::array_t<unsigned char>(std::vector<py::ssize_t>{picture.height, picture.width, 3}, bytes.data());
}

// hrt_get_picture, which hrt_stop() does not end, in parts: a wait counts as calling, so that a robot whose camera is
// silent would drive on.
int wait_for_picture(const std::string& camera, int format, std::vector<unsigned char>& bytes, double timeout_s,
                     hrt_picture& picture) {
  const auto part = [&](double seconds) {
    const int result =
        interruptible(hrt_get_picture, camera.c_str(), format, bytes.data(), bytes.size(), seconds, &picture);
    handle_signals();
    return result;
  };
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  double left_s = timeout_s;
  // the library itself refuses a time that is none
  while (left_s > kPart_s && timeout_s <= kLongest_s) {
    if (const int result = part(kPart_s); result != HRT_E_TIMEOUT) return result;
    left_s = std::max(0.0, timeout_s - std::chrono::duration<double>(Clock::now() - begin).count());
  }
  const int result = part(left_s);
  if (result == HRT_E_TIMEOUT && left_s != timeout_s) {
    raise(result, fmt::format("get_picture: no {} picture of {} within {} s", picture.number == 0 ? "first" : "other",
                              camera.empty() ? "the first camera" : "camera " + camera, timeout_s)
                      .c_str());
  }
  return result;
}

Picture get_picture(const std::string& camera, int format, double timeout_s, std::uint64_t other_than) {
  hrt_picture picture = hrt_picture_init();
  picture.number = other_than;
  std::vector<unsigned char> bytes(kFirstGuess);
  for (int tries = 0;; ++tries) {
    const int result = wait_for_picture(camera, format, bytes, timeout_s, picture);
    // too small for this one, which says so
    if (result == HRT_E_ARGUMENT && picture.bytes > bytes.size() && tries < kTries) {
      bytes.resize(picture.bytes);
      continue;
    }
    raise_unless_ok(result);
    return {picture, data_of(picture, bytes)};
  }
}

}  // namespace

void add_pictures(py::module_& module) {
  module.attr("PICTURE_RGB") = static_cast<int>(HRT_PICTURE_RGB);
  module.attr("PICTURE_JPEG") = static_cast<int>(HRT_PICTURE_JPEG);
  const auto property = [](auto member) {
    return [member](const Picture& picture) { return picture.properties.*member; };
  };
  py::class_<Picture>(module, "Picture", py::module_local(), "A picture: the members of hrt_picture, and its data.")
      .def_readonly("data", &Picture::data,
                    "PICTURE_RGB: uint8 of shape (height, width, 3), red, green, blue; PICTURE_JPEG: bytes, a file.")
      .def_property_readonly("width", property(&hrt_picture::width))
      .def_property_readonly("height", property(&hrt_picture::height))
      .def_property_readonly("number", property(&hrt_picture::number))
      .def_property_readonly("time_s", property(&hrt_picture::time_s))
      .def_property_readonly("age_ms", property(&hrt_picture::age_ms))
      .def_property_readonly("camera", [](const Picture& picture) { return std::string(picture.properties.camera); });
  module.def("get_picture", &get_picture, py::arg("camera") = "", py::arg("format") = static_cast<int>(HRT_PICTURE_RGB),
             py::arg("timeout_s") = 1.0, py::arg("other_than") = 0,
             "Returns the newest picture of a camera whose number is not `other_than`.\n\n"
             "camera: a name of the robot's description; \"\": its first camera.\n"
             "timeout_s: 0 to 60, wall clock; raises TimeoutError after it.\n"
             "Otherwise as hrt_get_picture.");
}

}  // namespace kenaf::python
