// How a failure propagates inside the library: thrown as an Error, turned into a return code at the C interface
// (hrt.cpp) and nowhere else. A thread of the library keeps the Failure that ended it, for the next calls to throw.
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

// An Error that other threads throw later. Its text is its own, while copies of an exception share one.
struct Failure {
  int code;
  std::string text;

  Error error() const { return {code, text}; }
};

}  // namespace kenaf::hrt
