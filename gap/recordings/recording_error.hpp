// An error in a recording or in its mapping, with the file and the place in it, in words for the user.
#pragma once

#include <stdexcept>

namespace kenaf::gap::recordings {

class RecordingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kenaf::gap::recordings
