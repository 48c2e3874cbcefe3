// toml++ itself, compiled once for all that read TOML. Debian's own library is not used: it would be one more that a
// robot's computer needs.
//
// Its assertions are off: some state of foreign text what the parser only then checks (3.0: parse_key() of "[!a]"), and
// would end the program. NDEBUG would turn them into assumptions, by which a compiler may leave that check out.
#undef NDEBUG
#define TOML_ASSERT(condition) static_cast<void>(0)
#define TOML_IMPLEMENTATION
#include <toml++/toml.h>
