#include "python/run_arrays.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <stdexcept>
#include <utility>

namespace kenaf::python {
namespace py = pybind11;

py::dict arrays_of(runs::Run run) {
  auto owned = std::make_unique<runs::Run>(std::move(run));
  const runs::Run& kept = *owned;
  const py::capsule owner(owned.get(), [](void* pointer) { delete static_cast<runs::Run*>(pointer); });
  (void)owned.release();  // to the capsule
  py::dict arrays;
  for (std::size_t c = 0; c < kept.columns.size(); ++c)
    arrays[py::str(kept.columns[c])] =
        py::array_t<double>(static_cast<py::ssize_t>(kept.values[c].size()), kept.values[c].data(), owner);
  return arrays;
}

Array array_of(const py::handle& values, std::vector<py::ssize_t> shape, const std::string& name) {
  Array array = Array::ensure(values);
  if (!array) {
    PyErr_Clear();
    throw std::invalid_argument(fmt::format("{}: is not an array of numbers", name));
  }
  bool fits = array.ndim() == static_cast<py::ssize_t>(shape.size());
  for (std::size_t i = 0; fits && i < shape.size(); ++i)
    fits = shape[i] < 0 || array.shape(static_cast<py::ssize_t>(i)) == shape[i];
  if (!fits)
    throw std::invalid_argument(fmt::format("{}: has the shape ({}), but must have ({})", name,
                                            fmt::join(array.shape(), array.shape() + array.ndim(), ", "),
                                            fmt::join(shape, ", ")));
  return array;
}

runs::Run run_of(const py::handle& columns) {
  const py::dict given = py::reinterpret_borrow<py::object>(columns);
  if (!given.contains("t_s")) throw std::invalid_argument("the run has no column t_s");
  const py::ssize_t rows = array_of(given["t_s"], {-1}, "t_s").shape(0);
  runs::Run run;
  for (const auto& [name, values] : given) {
    run.columns.push_back(name.cast<std::string>());
    const Array array = array_of(values, {rows}, run.columns.back());
    run.values.emplace_back(array.data(), array.data() + rows);
  }
  return run;
}

py::array_t<double> array_from(std::span<const double> values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

}  // namespace kenaf::python
