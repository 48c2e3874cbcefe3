// How a failure travels inside of the library: thrown as an Error, turned into a return code at the C border (hrt.cpp).
//
// Thread safety: a value.
#pragma once

#include <stdexcept>
#include <string>

#include "kenaf/hrt.h"

namespace kenaf::hrt {

class Error : public std::runtime_error {
 public:
  // `code`: one of hrt.h's HRT_E values; `text`: what was wrong, where, and what to do, on one line.
  Error(int code, const std::string& text) : std::runtime_error(text), code_(code) {}
  int code() const { return code_; }

 private:
  int code_;
};

}  // namespace kenaf::hrt
