#include "recording/store/manifest/replicate_set.h"

#include <algorithm>
#include <vector>

namespace imunoise::recording {
namespace {

v1::ReplicateRange range_of(std::uint32_t first, std::uint32_t last) {
  v1::ReplicateRange out;
  out.set_first(first);
  out.set_last(last);
  return out;
}

}  // namespace

bool holds(const ReplicateRanges& ranges, std::uint32_t replicate) {
  return std::any_of(ranges.begin(), ranges.end(), [&](const v1::ReplicateRange& one) {
    return one.first() <= replicate && replicate <= one.last();
  });
}

void insert(ReplicateRanges& ranges, std::uint32_t replicate) {
  std::uint32_t first = replicate;
  std::uint32_t last = replicate;
  std::vector<v1::ReplicateRange> out;
  for (const v1::ReplicateRange& one : ranges) {
    const bool touches = one.first() <= last + 1 && first <= one.last() + 1;
    if (!touches) {
      out.push_back(one);
      continue;
    }
    first = std::min(first, one.first());
    last = std::max(last, one.last());
  }
  out.push_back(range_of(first, last));
  std::sort(out.begin(), out.end(),
            [](const auto& a, const auto& b) { return a.first() < b.first(); });
  ranges.Assign(out.begin(), out.end());
}

void erase(ReplicateRanges& ranges, std::uint32_t replicate) {
  std::vector<v1::ReplicateRange> out;
  for (const v1::ReplicateRange& one : ranges) {
    if (replicate < one.first() || one.last() < replicate) {
      out.push_back(one);
      continue;
    }
    if (one.first() < replicate) out.push_back(range_of(one.first(), replicate - 1));
    if (replicate < one.last()) out.push_back(range_of(replicate + 1, one.last()));
  }
  ranges.Assign(out.begin(), out.end());
}

bool is_replicate_set(const ReplicateRanges& ranges, std::uint64_t most) {
  std::uint64_t before = 0;  // the last replicate of the range before
  std::uint64_t count = 0;
  for (const v1::ReplicateRange& one : ranges) {
    if (one.first() <= before || one.last() < one.first()) return false;
    before = one.last();
    count += std::uint64_t{one.last()} - one.first() + 1;
  }
  return count <= most;
}

}  // namespace imunoise::recording
