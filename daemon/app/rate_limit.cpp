#include "daemon/app/rate_limit.h"

#include <utility>

namespace imunoise::app {

std::optional<std::size_t> RateLimit::pass(const std::string& source, Time now) {
  Source& one = sources_.try_emplace(source, Source{now, 0, 0}).first->second;
  if (now - one.begin >= window_) {
    one.begin = now;
    one.said = 0;
  }
  if (one.said >= lines_) {
    ++one.left_out;
    return std::nullopt;
  }
  ++one.said;
  return std::exchange(one.left_out, 0);
}

}  // namespace imunoise::app
