// Runs as NumPy arrays, and back. All functions need the GIL.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <span>
#include <string>
#include <vector>

#include "formats/runs/run_file.hpp"

namespace kenaf::python {

// Returns a dict from column names to float64 arrays of shape (rows,). The arrays share the memory of `run`, which
// lives as long as any of them: nothing is copied.
pybind11::dict arrays_of(runs::Run run);

// `columns`: a mapping from names to sequences of numbers of equal length. Copies them. Throws std::invalid_argument
// that names the column if one is of another length or shape, or there is no t_s.
runs::Run run_of(const pybind11::handle& columns);

using Array = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

// Returns `values` as an array of the given shape, of which -1 is any length. Throws std::invalid_argument with `name`.
Array array_of(const pybind11::handle& values, std::vector<pybind11::ssize_t> shape, const std::string& name);

// A copy as an array of shape (n,).
pybind11::array_t<double> array_from(std::span<const double> values);

}  // namespace kenaf::python
