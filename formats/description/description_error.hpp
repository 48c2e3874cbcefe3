// An error in a robot's, world's or manoeuvre's description, with file, line and column in its text.
#pragma once

#include <stdexcept>

namespace kenaf::description {

class DescriptionError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kenaf::description
