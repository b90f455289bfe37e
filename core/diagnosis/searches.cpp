#include "core/diagnosis/searches.h"

#include <iterator>

#include "core/diagnosis/missing_noise.h"
#include "core/effects/known_effects.h"
#include "core/search/search_view.h"

namespace imunoise {

Suggestions search_effects(const Current& current, std::span<const Effect* const> effects,
                           const Progress& progress) {
  Suggestions out;
  const SearchView view(current);
  for (std::size_t i = 0; i < effects.size() && !progress.stopped(); ++i) {
    progress.report(static_cast<double>(i) / static_cast<double>(effects.size()));
    if (effects[i]->search == nullptr) continue;
    Suggestions found = effects[i]->search(view);
    std::move(found.begin(), found.end(), std::back_inserter(out));
  }
  return out;
}

Suggestions search_all(const Current& current, const Progress& progress) {
  Suggestions out = search_noise(current);
  Suggestions effects = search_effects(current, known_effects(), progress.part(0.1, 1.0));
  std::move(effects.begin(), effects.end(), std::back_inserter(out));
  return out;
}

}  // namespace imunoise
