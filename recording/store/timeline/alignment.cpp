#include "recording/store/timeline/alignment.h"

#include <cassert>

namespace imunoise::recording {

std::vector<double> at_times(const Numbers& numbers, std::span<const std::int64_t> times,
                             std::span<const std::int64_t> wanted) {
  assert(size(numbers) == times.size());
  std::vector<double> out(wanted.size(), 0.0);
  if (times.empty()) return out;
  std::visit(
      [&](const auto& values) {
        std::size_t next = 0;  // the first row not before the wanted time
        for (std::size_t i = 0; i < wanted.size(); ++i) {
          while (next < times.size() && times[next] < wanted[i]) ++next;
          if (next == 0 || (next < times.size() && times[next] == wanted[i])) {
            out[i] = static_cast<double>(values[next]);
            continue;
          }
          const auto before = static_cast<double>(values[next - 1]);
          if (next == times.size()) {
            out[i] = before;
            continue;
          }
          const double share = static_cast<double>(wanted[i] - times[next - 1]) /
                               static_cast<double>(times[next] - times[next - 1]);
          out[i] = before + share * (static_cast<double>(values[next]) - before);
        }
      },
      numbers);
  return out;
}

}  // namespace imunoise::recording
