#include "core/support/nearest_word.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <vector>

namespace imunoise {
namespace {

constexpr std::size_t kLongest = 64;        // letters; longer ones match nothing
constexpr std::size_t kShortestPrefix = 3;  // letters

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

// Optimal string alignment (Damerau 1964), a row of the table at a time: changed, added, missing
// and swapped letters count one each.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), last(before.size()), row(before.size());
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = last[j] + (a[i] == b[j] ? 0U : 1U);
      row[j + 1] = std::min({row[j] + 1, last[j + 1] + 1, replaced});
      if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
        row[j + 1] = std::min(row[j + 1], before[j - 1] + 1);
    }
  }
  return row.back();
}

}  // namespace

std::string_view nearest_word(std::string_view word, std::span<const std::string> known) {
  if (word.size() > kLongest) return {};
  const std::string wanted = lower(word);
  std::string_view best;
  std::size_t least = word.size();
  for (const std::string& one : known) {
    const std::size_t changes = distance(wanted, lower(one));
    if (changes < least && 3 * changes <= std::max<std::size_t>(word.size(), 3)) {
      best = one;
      least = changes;
    }
  }
  if (!best.empty() || word.size() < kShortestPrefix) return best;
  const auto begun = std::find_if(known.begin(), known.end(), [&](const std::string& one) {
    return lower(one).starts_with(wanted);
  });
  return begun == known.end() ? best : std::string_view(*begun);
}

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  const std::string_view near = nearest_word(word, known);
  return near.empty() ? "" : "did you mean '" + std::string(near) + "'?";
}

}  // namespace imunoise
