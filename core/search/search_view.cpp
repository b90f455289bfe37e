#include "core/search/search_view.h"

#include <algorithm>

#include "core/support/parallel.h"

namespace imunoise {

const SlowView& SearchView::slow() const {
  if (!slow_) slow_.emplace(current_);
  return *slow_;
}

SlowView::Means SearchView::over_time(const std::function<double(double seconds)>& function) const {
  const double rate = subject().rate.value;
  SlowView::Means out;
  for (std::size_t k = 0; k < subject().replicates(); ++k) {
    const auto block = static_cast<double>(slow().block(k));
    Eigen::VectorXd means(subject().length(k) / slow().block(k));
    for (Eigen::Index i = 0; i < means.size(); ++i)
      means(i) = function(subject().begins(k) + (static_cast<double>(i) + 0.5) * block / rate);
    out.push_back(std::move(means));
  }
  return out;
}

const std::vector<StepProducts>& SearchView::steps() const {
  if (!steps_) steps_ = step_products(current_);
  return *steps_;
}

const Innovations& SearchView::innovations() const {
  if (!innovations_) innovations_ = imunoise::innovations(current_.regression, current_.fit);
  return *innovations_;
}

const Innovations& SearchView::unmodulated() const {
  if (unmodulated_) return *unmodulated_;
  const std::vector<PowerView::Explained>& all = power_explained();
  const auto best = std::max_element(all.begin(), all.end(),
                                     [](const auto& a, const auto& b) { return a.gain < b.gain; });
  constexpr double kSurely = 12.0;  // nats beside power that wanders by itself
  if (best == all.end() || !(best->gain > kSurely)) return innovations();
  unmodulated_ = innovations();
  const auto number = static_cast<std::size_t>(best - all.begin());
  const VarianceCourse course{subject().witnesses[number].samples};
  take_out(modulation_by(course, *unmodulated_), course, *unmodulated_);
  return *unmodulated_;
}

const PowerView* SearchView::power() const {
  if (!power_) power_.emplace(PowerView::of(innovations()));
  return *power_ ? &**power_ : nullptr;
}

const std::vector<PowerView::Explained>& SearchView::power_explained() const {
  if (explained_) return *explained_;
  explained_.emplace();
  const PowerView* const view = power();
  if (view == nullptr) return *explained_;
  explained_->resize(subject().witnesses.size());
  for_each_index(explained_->size(), [&](std::size_t w) {
    (*explained_)[w] = view->explained({subject().witnesses[w].samples});
  });
  return *explained_;
}

}  // namespace imunoise
