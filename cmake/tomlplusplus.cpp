// toml++ itself, compiled once for all that read TOML. Debian's own library is not used: it would be one more that a
// robot's computer needs.
#define TOML_IMPLEMENTATION
#include <toml++/toml.h>
