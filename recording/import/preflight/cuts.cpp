#include "recording/import/preflight/cuts.h"

#include <algorithm>

#include "recording/import/table/options.h"

namespace imunoise::recording {

void Cuts::add_row(std::size_t row) {
  if (all_.empty() || all_.back().end != row || all_.back().begin == row)
    add(row, row + 1);
  else
    all_.back().end = row + 1;
}

std::vector<Cut> Cuts::joined() const {
  std::vector<Cut> sorted = all_;
  std::sort(sorted.begin(), sorted.end(),
            [](const Cut& a, const Cut& b) { return a.begin < b.begin; });
  std::vector<Cut> out;
  for (const Cut& cut : sorted) {
    if (out.empty() || cut.begin > out.back().end) {
      out.push_back(cut);
    } else {
      out.back().end = std::max(out.back().end, cut.end);
    }
  }
  return out;
}

Cuts::Left Cuts::of(std::size_t rows) const {
  std::vector<Cut> cuts = joined();
  cuts.push_back({rows, rows});
  std::vector<Stretch> every;
  std::size_t begin = 0;
  Left out;
  for (const Cut& cut : cuts) {
    if (cut.begin > begin) every.push_back({begin, cut.begin - begin});
    begin = std::max(begin, cut.end);
  }
  for (const Stretch& one : every) out.longest = std::max(out.longest, one.count);
  for (const Stretch& one : every) {
    if (one.count >= kMinimumSamples && 10 * one.count >= out.longest) out.stretches.push_back(one);
  }
  out.all = every.size();
  return out;
}

}  // namespace imunoise::recording
