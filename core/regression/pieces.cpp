// Regressions on stretches of the replicates.

#include <algorithm>

#include "core/regression/regression.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// A stretch of a series less its mean, which goes to `mean`.
SharedVector cut(const VectorRef& x, Index begin, Index length, double& mean) {
  Eigen::VectorXd out = x.segment(begin, length);
  mean = out.mean();
  out.array() -= mean;
  return out;
}

std::vector<SharedVector> transformed(const std::vector<SharedVector>& blocks) {
  std::vector<SharedVector> out(blocks.size());
  for_each_index(out.size(), [&](std::size_t b) { out[b] = cosine_transform(blocks[b]); });
  return out;
}

}  // namespace

Regression Regression::in_blocks(std::size_t blocks) const {
  const auto length =
      static_cast<Index>(quick_length(static_cast<std::size_t>(subject_->length(0)) / blocks));
  std::vector<Piece> pieces;
  for (std::size_t b = 0; b < blocks; ++b)
    pieces.push_back({0, static_cast<Index>(b) * length, length});
  // Columns are cut, too; only noise that follows a witness needs the witness itself.
  std::vector<const Witness*> witnesses;
  for (const EffectTerm& term : effects_) {
    if (term.effect->variance_course == nullptr) continue;
    const Witness* const one = subject_->find(term.witness);
    if (std::find(witnesses.begin(), witnesses.end(), one) == witnesses.end())
      witnesses.push_back(one);
  }
  return of_pieces(pieces, uncut(blocks), witnesses);
}

Regression Regression::beginnings(Index samples) const {
  std::vector<Piece> pieces;
  for (std::size_t k = 0; k < subject_->replicates(); ++k) {
    const auto length = static_cast<std::size_t>(std::min(samples, subject_->length(k)));
    pieces.push_back({k, 0, static_cast<Index>(quick_length(length))});
  }
  std::vector<const Witness*> witnesses;
  for (const Witness& one : subject_->witnesses) witnesses.push_back(&one);
  return of_pieces(pieces, subject_->parts, witnesses);
}

Regression Regression::of_pieces(const std::vector<Piece>& pieces, std::vector<Part> parts,
                                 const std::vector<const Witness*>& witnesses) const {
  const std::size_t count = pieces.size();
  const bool one_replicate = subject_->replicates() == 1;
  auto subject = std::make_shared<Subject>(
      Subject{subject_->rate, subject_->quantity, {}, {}, std::move(parts), {}});
  double level = 0.0;
  for (const Piece& at : pieces)
    subject->samples.push_back(cut(subject_->samples[at.replicate], at.begin, at.length, level));
  subject->cosines = transformed(subject->samples);
  for (const Witness* from : witnesses) {
    Witness& to =
        subject->witnesses.emplace_back(Witness{from->name, from->quantity, {}, {}, from->unit});
    for (const Piece& at : pieces) {
      to.samples.push_back(cut(from->samples[at.replicate], at.begin, at.length, level));
      to.levels.push_back(level + (from->levels.empty() ? 0.0 : from->levels[at.replicate]));
    }
    to.cosines = transformed(to.samples);
  }
  const auto shares = [&](const std::vector<double>& nats) {
    std::vector<double> out;
    for (const Piece& at : pieces) {
      if (nats.empty()) break;
      out.push_back(nats[at.replicate] * static_cast<double>(at.length) /
                    static_cast<double>(subject_->length(at.replicate)));
    }
    return out;
  };
  subject->own_nats = shares(subject_->own_nats);
  subject->reshaped_nats = shares(subject_->reshaped_nats);
  Regression out(subject);
  out.effects_ = effects_;
  out.first_ = first_;
  out.names_ = names_;
  if (one_replicate) {
    for (CoefficientName& name : out.names_) name.replicate = CoefficientName::kAll;
  }
  for (std::size_t e = 0; e < effects_.size(); ++e) {
    auto made = std::make_shared<Regressors>();
    made->replicates.resize(count);
    for (std::size_t k = 0; k < subject_->replicates(); ++k) {
      const Columns& columns = columns_[e]->replicates[k];
      const auto size = static_cast<Index>(columns.places.size());
      for (Index i = 0; i < size; ++i) {
        Eigen::VectorXd samples = Eigen::VectorXd::Zero(subject_->length(k));
        add_effect(effects_[e], *subject_, k, columns, Eigen::VectorXd::Unit(size, i), samples);
        samples.array() -= samples.mean();
        const Index place = columns.places[static_cast<std::size_t>(i)];
        std::vector<std::size_t> felt;
        for (std::size_t p = 0; p < count; ++p) {
          if (pieces[p].replicate != k) continue;
          const SharedVector piece = cut(samples, pieces[p].begin, pieces[p].length, level);
          constexpr double kNothing = 1e-12;
          if (!(piece.squaredNorm() > kNothing * samples.squaredNorm())) continue;
          felt.push_back(p);
          made->replicates[p].cosines.emplace_back(cosine_transform(piece));
          made->replicates[p].places.push_back(place);
        }
        if (one_replicate && felt.size() == 1)
          out.names_[static_cast<std::size_t>(first_[e] + place)].replicate = felt.front();
      }
    }
    out.columns_.push_back(std::move(made));
  }
  out.fill_moments();
  return out;
}

}  // namespace imunoise
