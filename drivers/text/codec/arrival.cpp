#include "drivers/text/codec/arrival.h"

#include <algorithm>
#include <cmath>

namespace imunoise::text {

void spread_in_time(std::vector<ArrivedRow>& rows, double period_ns) {
  std::int64_t came_ns = 0;
  for (std::size_t i = rows.size(); i-- > 0;) {
    const bool together = i + 1 < rows.size() && rows[i].host_time_ns == came_ns;
    came_ns = rows[i].host_time_ns;
    if (!together) continue;
    const auto& [row, time] = rows[i];
    const ArrivedRow& later = rows[i + 1];
    const bool known = row.time_ns && later.row.time_ns && *row.time_ns <= *later.row.time_ns;
    const std::int64_t step = known ? *later.row.time_ns - *row.time_ns : std::llround(period_ns);
    rows[i].host_time_ns = later.host_time_ns - step;
  }
}

}  // namespace imunoise::text
