#include "gap/diagnose/channels.hpp"

#include <algorithm>
#include <array>

namespace kenaf::gap::diagnose {
namespace {

constexpr auto kChannelCount =
    static_cast<std::size_t>(std::ranges::count_if(robot::columns(), &robot::Column::is_compared));

constexpr std::array<Channel, kChannelCount> compared_columns() {
  std::array<Channel, kChannelCount> channels{};
  std::size_t next = 0;
  for (const robot::Seen seen : {robot::Seen::drive, robot::Seen::body, robot::Seen::sensor})
    for (const robot::Column& column : robot::columns()) {
      const robot::Comparison& compared = column.comparison;
      if (column.is_compared() && compared.seen == seen)
        channels[next++] = {column.name,         column.unit,   column.wraps,  seen,
                            compared.resolution, compared.kind, compared.level};
    }
  return channels;
}

constexpr std::array<Channel, kChannelCount> kAllChannels = compared_columns();

}  // namespace

std::span<const Channel> diagnosis_channels() {
  return kAllChannels;
}

std::size_t kind_of(std::size_t channel) {
  std::size_t kind = 0;
  for (std::size_t c = 1; c <= channel; ++c)
    if (kAllChannels[c].kind != kAllChannels[c - 1].kind) ++kind;
  return kind;
}

std::string_view kind_name(std::size_t kind) {
  std::size_t channel = 0;
  while (kind_of(channel) != kind) ++channel;
  return kAllChannels[channel].kind;
}

std::size_t kind_count() {
  return kind_of(kAllChannels.size() - 1) + 1;
}

}  // namespace kenaf::gap::diagnose
