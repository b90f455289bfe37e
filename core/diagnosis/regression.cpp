#include "core/diagnosis/regression.h"

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

// One series in blocks of so many samples, each less its mean.
std::vector<Eigen::VectorXd> cut(const VectorRef& x, std::size_t blocks, Index length) {
  std::vector<Eigen::VectorXd> out(blocks);
  for (std::size_t b = 0; b < blocks; ++b) {
    out[b] = x.segment(static_cast<Index>(b) * length, length);
    out[b].array() -= out[b].mean();
  }
  return out;
}

std::vector<Eigen::VectorXd> transformed(const std::vector<Eigen::VectorXd>& blocks) {
  std::vector<Eigen::VectorXd> out(blocks.size());
  for_each_index(out.size(), [&](std::size_t b) { out[b] = cosine_transform(blocks[b]); });
  return out;
}

}  // namespace

Regression::Regression(std::shared_ptr<const Subject> subject)
    : subject_(std::move(subject)),
      replicates_(subject_->replicates()),
      moments_(subject_->replicates()) {
  std::iota(replicates_.begin(), replicates_.end(), 0);
  for_each_index(moments_.size(), [&](std::size_t k) { fill_moments(k); });
}

void Regression::fill_moments(std::size_t replicate) {
  const Eigen::VectorXd& response = subject_->cosines[replicate];
  std::vector<Eigen::Ref<const Eigen::VectorXd>> all{response};
  Moments made{empty_bands(response.size() + 1, subject_->rate), {}, {}};
  for (std::size_t e = 0; e < columns_.size(); ++e) {
    const Columns& columns = columns_[e]->replicates[replicate];
    for (Index i = 0; i < columns.cosines.cols(); ++i) {
      all.emplace_back(columns.cosines.col(i));
      made.places.push_back(first_[e] + columns.places[static_cast<std::size_t>(i)]);
    }
  }
  const Bands bands(response.size() + 1);
  const auto size = static_cast<Index>(all.size());
  made.product.assign(static_cast<std::size_t>(bands.size()), Eigen::MatrixXd(size, size));
  for (std::size_t b = 0; b < made.product.size(); ++b) {
    const Index begin = bands.edges[b];
    const Index width = bands.edges[b + 1] - begin;
    for (Index i = 0; i < size; ++i) {
      for (Index j = 0; j <= i; ++j) {
        const double mean = all[static_cast<std::size_t>(i)]
                                .segment(begin, width)
                                .dot(all[static_cast<std::size_t>(j)].segment(begin, width)) /
                            static_cast<double>(width);
        made.product[b](i, j) = mean;
        made.product[b](j, i) = mean;
      }
    }
    made.bands.power(static_cast<Index>(b)) = made.product[b](0, 0);
  }
  moments_[replicate] = std::move(made);
}

Regression Regression::with(const EffectTerm& term) const {
  Regression out = *this;
  auto columns = std::make_shared<const Regressors>(regressors_of(term, *subject_));
  out.effects_.push_back(term);
  out.names_.insert(out.names_.end(), columns->coefficients.begin(), columns->coefficients.end());
  const bool empty = columns->coefficients.empty();
  out.columns_.push_back(std::move(columns));
  out.first_.push_back(static_cast<Index>(out.names_.size()));
  if (!empty) for_each_index(moments_.size(), [&](std::size_t k) { out.fill_moments(k); });
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
  for_each_index(moments_.size(), [&](std::size_t k) { out.fill_moments(k); });
  return out;
}

Regression Regression::of(const std::vector<std::size_t>& replicates) const {
  Regression out = *this;
  out.replicates_ = replicates;
  return out;
}

Regression Regression::on(std::shared_ptr<const Subject> subject) const {
  Regression out = *this;
  out.subject_ = std::move(subject);
  for_each_index(out.moments_.size(), [&](std::size_t k) { out.fill_moments(k); });
  return out;
}

Regression Regression::in_blocks(std::size_t blocks) const {
  const auto length =
      static_cast<Index>(quick_length(static_cast<std::size_t>(subject_->length(0)) / blocks));
  auto parts = std::make_shared<Subject>(
      Subject{subject_->rate, subject_->quantity, {}, {}, uncut(blocks), {}});
  parts->samples = cut(subject_->samples[0], blocks, length);
  parts->cosines = transformed(parts->samples);
  // Columns are cut below; only noise that follows a witness needs the witness itself.
  for (const EffectTerm& term : effects_) {
    if (term.kind != EffectKind::kModulated || parts->find(term.witness) != nullptr) continue;
    const Witness& from = *subject_->find(term.witness);
    Witness& to = parts->witnesses.emplace_back(Witness{from.name, from.quantity, {}, {}});
    // The level of a block is part of what it says about the noise there.
    for (std::size_t b = 0; b < blocks; ++b)
      to.samples.emplace_back(from.samples[0].segment(static_cast<Index>(b) * length, length));
    to.cosines = transformed(to.samples);
  }
  if (!subject_->own_nats.empty())
    parts->own_nats.assign(blocks, subject_->own_nats[0] / static_cast<double>(blocks));
  Regression out(parts);
  out.effects_ = effects_;
  out.first_ = first_;
  out.names_ = names_;
  for (CoefficientName& name : out.names_) name.replicate = CoefficientName::kAll;
  for (std::size_t e = 0; e < effects_.size(); ++e) {
    auto made = std::make_shared<Regressors>();
    made->replicates.assign(blocks, {Eigen::MatrixXd(length - 1, 0), {}});
    const Eigen::MatrixXd samples = samples_of_regressor(effects_[e], *subject_, 0);
    for (Index i = 0; i < samples.cols(); ++i) {
      const std::vector<Eigen::VectorXd> each = cut(samples.col(i), blocks, length);
      double all = 0.0;
      for (const Eigen::VectorXd& one : each) all += one.squaredNorm();
      std::vector<std::size_t> felt;
      for (std::size_t b = 0; b < blocks; ++b) {
        constexpr double kNothing = 1e-12;
        if (!(each[b].squaredNorm() > kNothing * all)) continue;
        felt.push_back(b);
        Columns& to = made->replicates[b];
        to.cosines.conservativeResize(Eigen::NoChange, to.cosines.cols() + 1);
        to.cosines.rightCols(1) = cosine_transform(each[b]);
        to.places.push_back(i);
      }
      if (felt.size() == 1)
        out.names_[static_cast<std::size_t>(first_[e] + i)].replicate = felt.front();
    }
    out.columns_.push_back(std::move(made));
  }
  for_each_index(blocks, [&](std::size_t b) { out.fill_moments(b); });
  return out;
}

Regression::Normal Regression::normal_equations(const Model& noise) const {
  const auto n = static_cast<Index>(names_.size());
  Normal out{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const std::size_t k : replicates_) {
    const Moments& at = moments_[k];
    const auto q = static_cast<Index>(at.places.size());
    if (q == 0) continue;
    const Eigen::ArrayXd weight = weights(at.bands, noise);
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(1 + q, 1 + q);
    for (std::size_t b = 0; b < at.product.size(); ++b)
      sum += weight(static_cast<Index>(b)) * at.product[b];
    for (Index i = 0; i < q; ++i) {
      const Index row = at.places[static_cast<std::size_t>(i)];
      out.moment(row) += sum(1 + i, 0);
      for (Index j = 0; j < q; ++j)
        out.gram(row, at.places[static_cast<std::size_t>(j)]) += sum(1 + i, 1 + j);
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

EffectCoefficients Regression::under(const Model& noise, const Eigen::VectorXd& shared) const {
  if (names_.empty()) return {Eigen::VectorXd(0), Eigen::MatrixXd(0, 0)};
  Normal normal = normal_equations(noise);
  Eigen::VectorXd known = Eigen::VectorXd::Zero(shared.size());
  for (Index i = 0; i < known.size(); ++i) {
    if (names_[static_cast<std::size_t>(i)].replicate == CoefficientName::kAll)
      known(i) = shared(i);
  }
  normal.moment -= normal.gram * known;
  for (Index i = 0; i < known.size(); ++i) {
    if (names_[static_cast<std::size_t>(i)].replicate != CoefficientName::kAll) continue;
    normal.gram.row(i).setZero();
    normal.gram.col(i).setZero();
    normal.moment(i) = 0.0;
  }
  const Eigen::MatrixXd covariance = pseudo_inverse(normal.gram).matrix;
  return {known + covariance * normal.moment, covariance};
}

std::vector<BandedPower> Regression::residual(const Eigen::VectorXd& coefficients) const {
  std::vector<BandedPower> out;
  for (const std::size_t k : replicates_) {
    const Moments& at = moments_[k];
    Eigen::VectorXd left = Eigen::VectorXd::Ones(1 + static_cast<Index>(at.places.size()));
    for (std::size_t i = 0; i < at.places.size(); ++i)
      left(1 + static_cast<Index>(i)) = -coefficients(at.places[i]);
    BandedPower bands = at.bands;
    if (!at.places.empty()) {
      for (std::size_t b = 0; b < at.product.size(); ++b)
        bands.power(static_cast<Index>(b)) = std::max(0.0, left.dot(at.product[b] * left));
    }
    out.push_back(std::move(bands));
  }
  return out;
}

std::vector<Eigen::ArrayXd> Regression::leverage(const EffectCoefficients& found,
                                                 const Model& noise) const {
  std::vector<Eigen::ArrayXd> out;
  for (const std::size_t k : replicates_) {
    const Moments& at = moments_[k];
    const auto q = static_cast<Index>(at.places.size());
    Eigen::MatrixXd covariance(q, q);
    for (Index i = 0; i < q; ++i) {
      for (Index j = 0; j < q; ++j)
        covariance(i, j) = found.covariance(at.places[static_cast<std::size_t>(i)],
                                            at.places[static_cast<std::size_t>(j)]);
    }
    const Eigen::ArrayXd weight = weights(at.bands, noise);
    Eigen::ArrayXd share = Eigen::ArrayXd::Zero(weight.size());
    if (q > 0) {
      for (std::size_t b = 0; b < at.product.size(); ++b) {
        const auto place = static_cast<Index>(b);
        share(place) =
            weight(place) * covariance.cwiseProduct(at.product[b].bottomRightCorner(q, q)).sum();
      }
    }
    out.push_back(std::move(share));
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
  for (std::size_t e = 0; e < columns_.size(); ++e) {
    const Columns& columns = columns_[e]->replicates[replicate];
    for (Index i = 0; i < columns.cosines.cols(); ++i) {
      out -= coefficients(first_[e] + columns.places[static_cast<std::size_t>(i)]) *
             columns.cosines.col(i);
    }
  }
  return out;
}

Eigen::VectorXd Regression::residual_samples(const Eigen::VectorXd& coefficients,
                                             std::size_t replicate) const {
  Eigen::VectorXd out = subject_->samples[replicate];
  for (std::size_t e = 0; e < effects_.size(); ++e) {
    const Columns& columns = columns_[e]->replicates[replicate];
    if (columns.places.empty()) continue;
    const Eigen::MatrixXd samples = samples_of_regressor(effects_[e], *subject_, replicate);
    for (std::size_t i = 0; i < columns.places.size(); ++i)
      out -= coefficients(first_[e] + columns.places[i]) * samples.col(static_cast<Index>(i));
  }
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
