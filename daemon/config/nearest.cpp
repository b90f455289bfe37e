#include "daemon/config/nearest.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace imunoise::config {
namespace {

// Levenshtein's distance, a row of the table at a time.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0U : 1U);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

constexpr std::size_t kLongest = 64;  // letters; longer ones match nothing

}  // namespace

std::string_view nearest(std::string_view name, std::span<const std::string> known) {
  std::string_view best;
  std::size_t least = name.size();
  if (name.size() > kLongest) return best;
  for (const std::string& one : known) {
    const std::size_t changes = distance(name, one);
    if (changes < least && 3 * changes <= std::max<std::size_t>(name.size(), 3)) {
      best = one;
      least = changes;
    }
  }
  return best;
}

}  // namespace imunoise::config
