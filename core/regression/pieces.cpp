// Regressions on stretches of the replicates.

#include <algorithm>
#include <map>

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

// Places that a single piece has, and which.
std::map<Index, std::size_t> alone(const Regressors& regressors) {
  std::map<Index, std::size_t> out;
  std::map<Index, int> having;
  for (std::size_t p = 0; p < regressors.replicates.size(); ++p) {
    for (const Index place : regressors.replicates[p].places) {
      out[place] = p;
      ++having[place];
    }
  }
  std::erase_if(out, [&](const auto& one) { return having[one.first] > 1; });
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

// The columns of an effect in one replicate, cut. A piece that a column does not reach has none.
void Regression::cut_columns(std::size_t effect, std::size_t replicate,
                             const std::vector<Piece>& pieces, Regressors& to) const {
  constexpr double kNothing = 1e-12;
  const Columns& columns = columns_[effect]->replicates[replicate];
  const auto size = static_cast<Index>(columns.places.size());
  double level = 0.0;
  for (Index i = 0; i < size; ++i) {
    Eigen::VectorXd samples = Eigen::VectorXd::Zero(subject_->length(replicate));
    add_effect(effects_[effect], *subject_, replicate, columns, Eigen::VectorXd::Unit(size, i),
               samples);
    samples.array() -= samples.mean();
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      if (pieces[p].replicate != replicate) continue;
      const SharedVector piece = cut(samples, pieces[p].begin, pieces[p].length, level);
      if (!(piece.squaredNorm() > kNothing * samples.squaredNorm())) continue;
      to.replicates[p].cosines.emplace_back(cosine_transform(piece));
      to.replicates[p].places.push_back(columns.places[static_cast<std::size_t>(i)]);
    }
  }
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
  for (const auto& one : subject_->evenings) {
    auto made = std::make_shared<Evening>();
    for (const Piece& at : pieces) {
      made->noise.push_back(one->noise_of(at.replicate));
      const SharedVector& all = one->factor[at.replicate];
      made->factor.push_back(
          all.size() < 2 ? all : SharedVector(all.segment(at.begin, at.length).eval()));
    }
    subject->evenings.push_back(std::move(made));
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
  std::vector<std::shared_ptr<Regressors>> made;
  for (std::size_t e = 0; e < effects_.size(); ++e) {
    made.push_back(std::make_shared<Regressors>());
    made.back()->replicates.resize(count);
  }
  const std::size_t replicates = subject_->replicates();
  for_each_index(effects_.size() * replicates, [&](std::size_t i) {
    cut_columns(i / replicates, i % replicates, pieces, *made[i / replicates]);
  });
  for (std::size_t e = 0; e < effects_.size(); ++e) {
    if (one_replicate) {
      for (const auto& [place, piece] : alone(*made[e]))
        out.names_[static_cast<std::size_t>(first_[e] + place)].replicate = piece;
    }
    out.columns_.push_back(std::move(made[e]));
  }
  out.fill_moments();
  return out;
}

}  // namespace imunoise
