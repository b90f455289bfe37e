#include "recording/import/preflight/frozen.h"

#include <algorithm>
#include <cmath>

#include "recording/import/preflight/holes.h"
#include "recording/import/preflight/motion.h"
#include "recording/import/table/options.h"

namespace imunoise::recording {
namespace {

constexpr std::size_t kShortest = 64;  // rows of a run
constexpr double kChance = 1e-6;       // of such a run in a recording

// Rows that repeat the row before, in runs.
std::vector<Cut> repeating(const std::vector<Column>& columns,
                           const std::vector<std::size_t>& moving) {
  std::vector<Cut> out;
  const std::size_t rows = size(columns.front().samples);
  for (std::size_t i = 1; i < rows; ++i) {
    const bool same = std::all_of(moving.begin(), moving.end(),
                                  [&](std::size_t c) { return repeats(columns[c], i); });
    if (!same) continue;
    if (out.empty() || out.back().end != i) out.push_back({i, i});
    out.back().end = i + 1;
  }
  return out;
}

}  // namespace

std::vector<Cut> frozen_in(const std::vector<Column>& columns, const std::vector<Unit>& units) {
  const std::vector<std::size_t> moving = channels_of_motion(columns, units);
  if (moving.empty()) return {};
  const auto rows = static_cast<double>(size(columns.front().samples));
  std::vector<Cut> out = repeating(columns, moving);
  double by_chance = 1.0;  // rows
  std::erase_if(out, [&](const Cut& run) {
    const std::size_t length = run.end - run.begin;
    if (length < kShortest) by_chance += static_cast<double>(length);
    return length < kShortest;
  });
  double frozen = 0.0;
  for (const Cut& run : out) frozen += static_cast<double>(run.end - run.begin);
  if (rows - frozen < static_cast<double>(kMinimumSamples)) return {};
  const double once = std::log(by_chance / (rows - frozen + 1.0));
  std::erase_if(out, [&](const Cut& run) {
    return static_cast<double>(run.end - run.begin) * once + std::log(rows) > std::log(kChance);
  });
  return out;
}

}  // namespace imunoise::recording
