// How a failure propagates inside the library: thrown as an Error, turned into a return code at the C interface
// (hrt.cpp) and nowhere else. A thread of the library keeps the Error that ended it, for the next call to throw.
//
// Thread safety: a value.
#pragma once

#include <stdexcept>
#include <string>

#include "kenaf/hrt.h"

namespace kenaf::hrt {

class Error : public std::runtime_error {
 public:
  // `code`: one of hrt.h's HRT_E values; `text`: what is wrong, where, and what to do, on one line.
  Error(int code, const std::string& text) : std::runtime_error(text), code_(code) {}
  int code() const { return code_; }

 private:
  int code_;
};

}  // namespace kenaf::hrt
