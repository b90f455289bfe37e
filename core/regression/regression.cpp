#include "core/regression/regression.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/spectrum/bands.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// Weights of bands under a model: coefficients over spectrum.
Eigen::ArrayXd weights(const BandedPower& bands, const Model& noise) {
  return bands.count / spectrum(noise, bands.frequency);
}

BandedPower empty_bands(Index n, Hertz rate) {
  const Bands bands(n);
  const Eigen::ArrayXd zero = Eigen::ArrayXd::Zero(bands.size());
  return {bands.frequency, bands.count, zero, zero, zero, static_cast<std::size_t>(n), rate};
}

// Numbers i ≥ j as one.
Index pair_of(Index i, Index j) { return i * (i + 1) / 2 + j; }

}  // namespace

Regression::Regression(std::shared_ptr<const Subject> subject)
    : first_subject_(std::move(subject)),
      subject_(first_subject_),
      replicates_(subject_->replicates()) {
  std::iota(replicates_.begin(), replicates_.end(), 0);
  fill_moments();
}

void Regression::fill_moments() {
  moments_.assign(subject_->replicates(), nullptr);
  for_each_index(moments_.size(), [&](std::size_t k) { extend_moments(k); });
}

void Regression::extend_moments(std::size_t replicate) {
  const SharedVector& response = subject_->cosines[replicate];
  const Bands bands(response.size() + 1);
  Moments made{empty_bands(response.size() + 1, subject_->rate), {}, {}};
  made.product.resize(bands.size(), 0);
  if (moments_[replicate]) made = *moments_[replicate];
  std::vector<const SharedVector*> all{&response};
  made.places.clear();
  for (std::size_t e = 0; e < columns_.size(); ++e) {
    const Columns& columns = columns_[e]->replicates[replicate];
    for (std::size_t i = 0; i < columns.places.size(); ++i) {
      all.push_back(&columns.cosines[i]);
      made.places.push_back(first_[e] + columns.places[i]);
    }
  }
  const Index known = made.product.cols();
  const auto size = static_cast<Index>(all.size());
  made.product.conservativeResize(Eigen::NoChange, pair_of(size, 0));
  for (Index b = 0; b < bands.size(); ++b) {
    const Index begin = bands.edges[static_cast<std::size_t>(b)];
    const Index width = bands.edges[static_cast<std::size_t>(b) + 1] - begin;
    const auto segment = [&](Index i) {
      return all[static_cast<std::size_t>(i)]->segment(begin, width);
    };
    const auto mean = [&](Index i, Index j) {
      return segment(i).dot(segment(j)) / static_cast<double>(width);
    };
    for (Index i = 0; i < size; ++i) {
      if (pair_of(i, i) < known) continue;
      // A column of one octave is nothing beyond it.
      const double square = mean(i, i);
      for (Index j = 0; j < i; ++j) {
        if (pair_of(i, j) < known) continue;
        const bool apart = square == 0.0 || made.product(b, pair_of(j, j)) == 0.0;
        made.product(b, pair_of(i, j)) = apart ? 0.0 : mean(i, j);
      }
      made.product(b, pair_of(i, i)) = square;
    }
  }
  made.bands.power = made.product.col(0);
  moments_[replicate] = std::make_shared<const Moments>(std::move(made));
}

Eigen::ArrayXd Regression::Moments::of_columns(const Eigen::MatrixXd& symmetric) const {
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(product.rows());
  for (Index i = 0; i < symmetric.rows(); ++i) {
    for (Index j = 0; j <= i; ++j)
      out += (i == j ? 1.0 : 2.0) * symmetric(i, j) * product.col(pair_of(i + 1, j + 1));
  }
  return out;
}

Regression Regression::with(const EffectTerm& term) const {
  Regression out = *this;
  auto columns = std::make_shared<const Regressors>(regressors_of(term, *subject_));
  out.effects_.push_back(term);
  out.names_.insert(out.names_.end(), columns->coefficients.begin(), columns->coefficients.end());
  const bool empty = columns->coefficients.empty();
  out.columns_.push_back(std::move(columns));
  out.first_.push_back(static_cast<Index>(out.names_.size()));
  if (!empty) for_each_index(moments_.size(), [&](std::size_t k) { out.extend_moments(k); });
  return out;
}

Regression Regression::without(std::size_t effect) const {
  Regression out = *this;
  const auto place = static_cast<std::ptrdiff_t>(effect);
  const Index taken = first_[effect + 1] - first_[effect];
  out.effects_.erase(out.effects_.begin() + place);
  out.columns_.erase(out.columns_.begin() + place);
  out.names_.erase(out.names_.begin() + first_[effect], out.names_.begin() + first_[effect + 1]);
  out.first_.erase(out.first_.begin() + place + 1);
  for (std::size_t e = effect + 1; e < out.first_.size(); ++e) out.first_[e] -= taken;
  if (taken == 0) return out;
  for (auto& one : out.moments_)
    one = std::make_shared<const Moments>(one->without(first_[effect], first_[effect + 1]));
  return out;
}

Regression::Moments Regression::Moments::without(Index first, Index end) const {
  Moments out{bands, {}, {}};
  std::vector<Index> kept{0};  // the response, then the columns that stay
  for (std::size_t c = 0; c < places.size(); ++c) {
    if (places[c] >= first && places[c] < end) continue;
    kept.push_back(static_cast<Index>(c) + 1);
    out.places.push_back(places[c] < first ? places[c] : places[c] - (end - first));
  }
  const auto size = static_cast<Index>(kept.size());
  out.product.resize(product.rows(), pair_of(size, 0));
  for (Index i = 0; i < size; ++i) {
    for (Index j = 0; j <= i; ++j)
      out.product.col(pair_of(i, j)) = product.col(
          pair_of(kept[static_cast<std::size_t>(i)], kept[static_cast<std::size_t>(j)]));
  }
  return out;
}

Regression Regression::of(const std::vector<std::size_t>& replicates) const {
  Regression out = *this;
  out.replicates_ = replicates;
  return out;
}

Regression Regression::on(std::shared_ptr<const Subject> subject) const {
  Regression out = *this;
  const std::size_t known = subject_->evenings.size();
  out.subject_ = std::move(subject);
  if (out.subject_->evenings.size() > known) {
    for (auto& one : out.columns_)
      one = std::make_shared<const Regressors>(made_even(*one, *out.subject_, known));
  }
  out.fill_moments();
  return out;
}

Regression::Normal Regression::normal_equations(const Model& noise) const {
  const auto n = static_cast<Index>(names_.size());
  Normal out{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const std::size_t k : replicates_) {
    const Moments& at = *moments_[k];
    const auto q = static_cast<Index>(at.places.size());
    if (q == 0) continue;
    const Eigen::VectorXd sum = at.product.matrix().transpose() * weights(at.bands, noise).matrix();
    for (Index i = 0; i < q; ++i) {
      const Index row = at.places[static_cast<std::size_t>(i)];
      out.moment(row) += sum(pair_of(1 + i, 0));
      for (Index j = 0; j < q; ++j)
        out.gram(row, at.places[static_cast<std::size_t>(j)]) +=
            sum(pair_of(1 + std::max(i, j), 1 + std::min(i, j)));
    }
  }
  return out;
}

EffectCoefficients Regression::under(const Model& noise) const {
  if (names_.empty()) return {Eigen::VectorXd(0), Eigen::MatrixXd(0, 0)};
  const Normal normal = normal_equations(noise);
  const Eigen::MatrixXd covariance = pseudo_inverse(normal.gram).matrix;
  return {covariance * normal.moment, covariance};
}

EffectCoefficients Regression::under(const Model& noise, const Eigen::VectorXd& shared,
                                     const Regression& others) const {
  if (names_.empty()) return {Eigen::VectorXd(0), Eigen::MatrixXd(0, 0)};
  Normal normal = normal_equations(noise);
  Eigen::VectorXd known = Eigen::VectorXd::Zero(shared.size());
  std::vector<Index> told;
  for (Index i = 0; i < known.size(); ++i) {
    const bool by_all = names_[static_cast<std::size_t>(i)].replicate == CoefficientName::kAll;
    if (!by_all || !others.shows(i)) continue;
    known(i) = shared(i);
    told.push_back(i);
  }
  normal.moment -= normal.gram * known;
  for (const Index i : told) {
    normal.gram.row(i).setZero();
    normal.gram.col(i).setZero();
    normal.moment(i) = 0.0;
  }
  const Eigen::MatrixXd covariance = pseudo_inverse(normal.gram).matrix;
  return {known + covariance * normal.moment, covariance};
}

bool Regression::shows(Index coefficient) const {
  constexpr double kNothing = 1e-9;  // of what all replicates have of it
  const auto power = [&](const Moments& at) {
    const auto place = std::find(at.places.begin(), at.places.end(), coefficient);
    if (place == at.places.end()) return 0.0;
    const auto column = static_cast<Index>(place - at.places.begin()) + 1;
    return (at.product.col(pair_of(column, column)) * at.bands.count).sum();
  };
  double here = 0.0;
  for (const std::size_t k : replicates_) here += power(*moments_[k]);
  double all = 0.0;
  for (const auto& one : moments_) all += power(*one);
  return here > kNothing * all;
}

std::vector<BandedPower> Regression::residual(const Eigen::VectorXd& coefficients) const {
  std::vector<BandedPower> out;
  for (const std::size_t k : replicates_) {
    const Moments& at = *moments_[k];
    out.push_back(at.bands);
    const auto q = static_cast<Index>(at.places.size());
    if (q == 0) continue;
    Eigen::VectorXd own(q);
    for (Index i = 0; i < q; ++i) own(i) = coefficients(at.places[static_cast<std::size_t>(i)]);
    Eigen::ArrayXd& power = out.back().power;
    power += at.of_columns(own * own.transpose());
    for (Index i = 0; i < q; ++i) power -= 2.0 * own(i) * at.product.col(pair_of(1 + i, 0));
    power = power.max(0.0);
  }
  return out;
}

std::vector<Eigen::ArrayXd> Regression::leverage(const EffectCoefficients& found,
                                                 const Model& noise) const {
  std::vector<Eigen::ArrayXd> out;
  for (const std::size_t k : replicates_) {
    const Moments& at = *moments_[k];
    const auto q = static_cast<Index>(at.places.size());
    Eigen::MatrixXd covariance(q, q);
    for (Index i = 0; i < q; ++i) {
      for (Index j = 0; j < q; ++j)
        covariance(i, j) = found.covariance(at.places[static_cast<std::size_t>(i)],
                                            at.places[static_cast<std::size_t>(j)]);
    }
    out.emplace_back(weights(at.bands, noise) * at.of_columns(covariance));
  }
  return out;
}

std::vector<BandedPower> Regression::residual(const EffectCoefficients& found,
                                              const Model& noise) const {
  std::vector<BandedPower> out = residual(found.value);
  if (names_.empty()) return out;
  const std::vector<Eigen::ArrayXd> taken = leverage(found, noise);
  for (std::size_t i = 0; i < out.size(); ++i) {
    // A band that lost all its freedom says nothing; what is left of it must not be divided by.
    constexpr double kLeast = 1e-3;
    const Eigen::ArrayXd left = (out[i].count - taken[i]).max(kLeast * out[i].count);
    out[i].power *= out[i].count / left;
    out[i].count = left;
  }
  return out;
}

Eigen::VectorXd Regression::residual_cosines(const Eigen::VectorXd& coefficients,
                                             std::size_t replicate) const {
  Eigen::VectorXd out = subject_->cosines[replicate];
  const std::vector<Index>& places = moments_[replicate]->places;
  Eigen::VectorXd factors(static_cast<Index>(places.size()));
  for (Index c = 0; c < factors.size(); ++c)
    factors(c) = -coefficients(places[static_cast<std::size_t>(c)]);
  add_columns(replicate, factors, out);
  return out;
}

void Regression::add_columns(std::size_t replicate, const Eigen::VectorXd& factors,
                             Eigen::VectorXd& to) const {
  std::vector<const SharedVector*> all;
  for (const auto& effect : columns_) {
    for (const SharedVector& one : effect->replicates[replicate].cosines) all.push_back(&one);
  }
  const Eigen::ArrayXXd& product = moments_[replicate]->product;
  const Bands bands(to.size() + 1);
  for (Index b = 0; b < bands.size(); ++b) {
    const Index begin = bands.edges[static_cast<std::size_t>(b)];
    const Index width = bands.edges[static_cast<std::size_t>(b) + 1] - begin;
    for (Index c = 0; c < factors.size(); ++c) {
      if (factors(c) == 0.0 || product(b, pair_of(c + 1, c + 1)) == 0.0) continue;
      to.segment(begin, width) +=
          factors(c) * all[static_cast<std::size_t>(c)]->segment(begin, width);
    }
  }
}

Eigen::VectorXd Regression::residual_samples(const Eigen::VectorXd& coefficients,
                                             std::size_t replicate) const {
  Eigen::VectorXd out = subject_->samples[replicate];
  // Columns that are known by their transforms alone: their sum takes one transform back.
  Eigen::VectorXd factors =
      Eigen::VectorXd::Zero(static_cast<Index>(moments_[replicate]->places.size()));
  Index at = 0;
  for (std::size_t e = 0; e < effects_.size(); ++e) {
    const Columns& columns = columns_[e]->replicates[replicate];
    Eigen::VectorXd own(static_cast<Index>(columns.places.size()));
    for (std::size_t i = 0; i < columns.places.size(); ++i)
      own(static_cast<Index>(i)) = -coefficients(first_[e] + columns.places[i]);
    const bool in_time = effects_[e].effect->add != nullptr && subject_->evenings.empty();
    if (in_time || !columns.samples.empty()) {
      add_effect(effects_[e], *subject_, replicate, columns, own, out);
    } else {
      factors.segment(at, own.size()) = own;
    }
    at += own.size();
  }
  if ((factors.array() == 0.0).all()) return out;
  Eigen::VectorXd cosines = Eigen::VectorXd::Zero(out.size() - 1);
  add_columns(replicate, factors, cosines);
  out += inverse_cosine_transform(cosines);
  return out;
}

std::vector<BandedPower> pooled(std::span<const BandedPower> replicates) {
  std::vector<BandedPower> out;
  for (const BandedPower& one : replicates) {
    auto same = std::find_if(out.begin(), out.end(), [&](const BandedPower& other) {
      return other.samples == one.samples;
    });
    if (same == out.end()) {
      out.push_back(one);
      continue;
    }
    same->power = (same->count * same->power + one.count * one.power) / (same->count + one.count);
    same->count += one.count;
  }
  return out;
}

}  // namespace imunoise
