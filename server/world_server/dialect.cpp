#include "server/world_server/dialect.hpp"

namespace kenaf::world_server {

using protocol::usarsim::NumberFormat;

Formats formats_of(Dialect dialect) {
  const NumberFormat two{2, false}, four{4, false};
  const NumberFormat cut_two{2, true}, cut_three{3, true}, cut_four{4, true};
  if (dialect == Dialect::ut2004) return {two, two, four, two, two, four, cut_four, four};
  // INS writes its vectors like the engine: two digits.
  return {cut_four, cut_four, cut_four, cut_three, two, cut_two, cut_four, cut_four};
}

Formats formats_with(int decimals) {
  const NumberFormat all{decimals, false};
  return {all, all, all, all, all, all, all, all};
}

}  // namespace kenaf::world_server
