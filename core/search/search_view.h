#pragma once

#include <functional>
#include <optional>

#include "core/regression/current.h"
#include "core/search/power_view.h"
#include "core/search/slow_view.h"
#include "core/search/step_products.h"
#include "core/search/suggestion.h"

namespace imunoise {

/// What the searches for effects look at: the current model and views of what it leaves, each made
/// when a search first asks for it. One thread at a time may ask.
class SearchView {
 public:
  explicit SearchView(const Current& current) : current_(current) {}

  const Current& current() const { return current_; }
  const Subject& subject() const { return current_.subject(); }
  const SlowView& slow() const;
  /// Block means, as SlowView wants them, of a function of the time in s from the first sample of
  /// what was recorded.
  SlowView::Means over_time(const std::function<double(double seconds)>& function) const;
  const std::vector<StepProducts>& steps() const;
  const Innovations& innovations() const;
  /// The same less what a witness makes of their power, if one does beyond doubt: it comes first,
  /// and what else happens to the power is judged beside it.
  const Innovations& unmodulated() const;
  /// Null where a replicate is too short for it.
  const PowerView* power() const;
  /// What each witness explains of the power's course, in their order; none without a power view.
  const std::vector<PowerView::Explained>& power_explained() const;

 private:
  const Current& current_;
  mutable std::optional<SlowView> slow_;
  mutable std::optional<std::vector<StepProducts>> steps_;
  mutable std::optional<Innovations> innovations_;
  mutable std::optional<Innovations> unmodulated_;
  mutable std::optional<std::optional<PowerView>> power_;
  mutable std::optional<std::vector<PowerView::Explained>> explained_;
};

}  // namespace imunoise
