#include "core/wavelet/scales.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <iterator>

namespace imunoise {

Scales::Scales(std::vector<std::int64_t> half_widths) : half_widths_(std::move(half_widths)) {
  assert(std::is_sorted(half_widths_.begin(), half_widths_.end()));
  assert(half_widths_.empty() || half_widths_.front() >= 1);
}

Scales Scales::for_samples(std::size_t samples, int per_octave) {
  assert(per_octave == 1 || per_octave == 2 || per_octave == 4);
  std::vector<std::int64_t> out;
  const int levels = static_cast<int>(std::bit_width(samples)) - 2;  // floor(log2) - 1
  for (int level = 0; level < levels; ++level) {
    const std::int64_t dyadic = std::int64_t{1} << level;
    out.push_back(dyadic);
    for (int step = 1; step < per_octave && level < levels - 1; ++step) {
      if (dyadic * step % per_octave == 0) out.push_back(dyadic + dyadic * step / per_octave);
    }
  }
  return Scales(std::move(out));
}

Eigen::ArrayXd Scales::half_widths() const {
  Eigen::ArrayXd out(static_cast<Eigen::Index>(size()));
  std::transform(begin(), end(), out.begin(),
                 [](std::int64_t m) { return static_cast<double>(m); });
  return out;
}

Scales Scales::with(const Scales& others) const {
  std::vector<std::int64_t> all;
  std::set_union(begin(), end(), others.begin(), others.end(), std::back_inserter(all));
  return Scales(std::move(all));
}

Scales Scales::where(const std::vector<bool>& keep) const {
  assert(keep.size() == size());
  std::vector<std::int64_t> out;
  for (std::size_t i = 0; i < size(); ++i) {
    if (keep[i]) out.push_back(half_widths_[i]);
  }
  return Scales(std::move(out));
}

}  // namespace imunoise
