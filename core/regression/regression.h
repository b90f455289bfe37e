#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/effect/columns.h"
#include "core/model/model.h"

namespace imunoise {

/// Coefficients of effects under a noise model.
struct EffectCoefficients {
  Eigen::VectorXd value;       ///< of all effects, in their order
  Eigen::MatrixXd covariance;  ///< under that noise
};

/// The replicates of a subject regressed on effects, in the bands of the cosine transform: all that
/// an estimate needs are the mean products within each band.
class Regression {
 public:
  /// Without effects.
  explicit Regression(std::shared_ptr<const Subject> subject);
  /// With one effect more. Precondition: check(term, subject).
  Regression with(const EffectTerm& term) const;
  /// With one effect less, by its number.
  Regression without(std::size_t effect) const;
  /// The same effects on other samples of the same replicates.
  Regression on(std::shared_ptr<const Subject> subject) const;
  /// Only some of the replicates (by number); coefficients that none of them has are zero.
  Regression of(const std::vector<std::size_t>& replicates) const;
  /// The only replicate cut into so many blocks of equal length, a replicate each. A coefficient
  /// that a single block feels (a step's height) belongs to that block, all others are shared.
  /// Effects keep the form that they have over the whole: residual_samples() has no meaning then.
  Regression in_blocks(std::size_t blocks) const;
  /// The beginning of each replicate, so many samples of it at most, with all witnesses. Effects
  /// keep their form, too.
  Regression beginnings(Eigen::Index samples) const;

  const Subject& subject() const { return *subject_; }
  const std::shared_ptr<const Subject>& shared_subject() const { return subject_; }
  /// What it was made from, before on().
  const std::shared_ptr<const Subject>& first_subject() const { return first_subject_; }
  /// The replicates that count, by their numbers.
  const std::vector<std::size_t>& replicates() const { return replicates_; }
  const std::vector<EffectTerm>& effects() const { return effects_; }
  const std::vector<CoefficientName>& coefficients() const { return names_; }
  /// First coefficient of an effect, by its number; effects().size() gives the end.
  Eigen::Index first(std::size_t effect) const { return first_[effect]; }

  /// Generalised least squares under a noise model (a weighting of each band by 1/spectrum).
  EffectCoefficients under(const Model& noise) const;
  /// The same with the coefficients that `others`, further replicates, share with these: known are
  /// those that the others show.
  EffectCoefficients under(const Model& noise, const Eigen::VectorXd& shared,
                           const Regression& others) const;
  /// Whether the replicates that count show a coefficient: two levels that only one replicate
  /// visits have a height there alone.
  bool shows(Eigen::Index coefficient) const;
  /// Power that the coefficients leave in every replicate, as it is: for likelihoods.
  std::vector<BandedPower> residual(const Eigen::VectorXd& coefficients) const;
  /// The same with the degrees of freedom that the coefficients took away: for estimating noise.
  std::vector<BandedPower> residual(const EffectCoefficients& found, const Model& noise) const;
  /// What the coefficients leave of a replicate, and its transform.
  Eigen::VectorXd residual_samples(const Eigen::VectorXd& coefficients,
                                   std::size_t replicate) const;
  Eigen::VectorXd residual_cosines(const Eigen::VectorXd& coefficients,
                                   std::size_t replicate) const;
  /// Share of the information on some coefficients that lies in each band of each replicate: all
  /// add up to their number.
  std::vector<Eigen::ArrayXd> leverage(const EffectCoefficients& found, const Model& noise) const;

 private:
  // Products within the bands of one replicate: of the response, then of its columns.
  struct Moments {
    BandedPower bands;                 // of the response
    std::vector<Eigen::Index> places;  // of its columns among all coefficients
    // Bands × pairs, mean over the band. The response is number 0, its columns are those from 1 on;
    // numbers i ≥ j are pair_of(i, j).
    Eigen::ArrayXXd product;
    // Σ over pairs of what a symmetric matrix (columns)² says of them, a band each; less the
    // response.
    Eigen::ArrayXd of_columns(const Eigen::MatrixXd& symmetric) const;
    // Less the columns of the coefficients from `first` to before `end`.
    Moments without(Eigen::Index first, Eigen::Index end) const;
  };

  std::shared_ptr<const Subject> first_subject_;
  std::shared_ptr<const Subject> subject_;
  std::vector<EffectTerm> effects_;
  std::vector<CoefficientName> names_;
  std::vector<Eigen::Index> first_{0};
  // The columns of each effect, shared with the regressions that this one was made from.
  std::vector<std::shared_ptr<const Regressors>> columns_;
  std::vector<std::size_t> replicates_;                  // those that count
  std::vector<std::shared_ptr<const Moments>> moments_;  // one a replicate of the subject

  // A stretch of a replicate.
  struct Piece {
    std::size_t replicate;
    Eigen::Index begin;
    Eigen::Index length;  // a quick_length()
  };
  // These as replicates, with the named witnesses. `parts`: where they lie.
  Regression of_pieces(const std::vector<Piece>& pieces, std::vector<Part> parts,
                       const std::vector<const Witness*>& witnesses) const;
  void cut_columns(std::size_t effect, std::size_t replicate, const std::vector<Piece>& pieces,
                   Regressors& to) const;
  void fill_moments();
  // Of what there are already, all but products with further columns.
  void extend_moments(std::size_t replicate);
  // Adds the columns of a replicate, times a factor each, band by band: where a column is nothing
  // it costs nothing.
  void add_columns(std::size_t replicate, const Eigen::VectorXd& factors,
                   Eigen::VectorXd& to) const;
  // Normal equations of all coefficients.
  struct Normal {
    Eigen::MatrixXd gram;
    Eigen::VectorXd moment;
  };
  Normal normal_equations(const Model& noise) const;
};

/// Replicates of the same length, with their powers averaged: the same likelihood from fewer
/// numbers.
std::vector<BandedPower> pooled(std::span<const BandedPower> replicates);

}  // namespace imunoise
