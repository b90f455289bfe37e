#include "core/search/noise_bump.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/spectrum/bands.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr Index kWide = 64;  // bands of equal width up to half the sampling rate

Index place_of(double frequency, Index coefficients) {
  return std::clamp<Index>(coefficients_below(frequency, coefficients + 1), 0, coefficients);
}

// Terms of the noise that have a peak of their own. They may stand for what is sought.
Model without_peaks(const Model& noise) {
  const Frequencies frequency(Eigen::ArrayXd::LinSpaced(512, 0.5, 511.5) / 1024.0);
  Model out;
  for (const Term& term : noise.terms) {
    Model alone;
    alone.terms.push_back(term);
    const Eigen::ArrayXd power = spectrum(alone, frequency);
    constexpr double kPeak = 1.5;
    const double ends = std::max(power(0), power(power.size() - 1));
    if (!(power.maxCoeff() > kPeak * ends)) out.terms.push_back(term);
  }
  return out;
}

// Logarithm of the power over that of the noise without peaks, in wide bands.
Eigen::ArrayXd log_ratio(const Current& current) {
  Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(kWide);
  Eigen::ArrayXd count = Eigen::ArrayXd::Zero(kWide);
  for (std::size_t k = 0; k < current.cosines.size(); ++k) {
    const SharedVector& cosines = current.cosines[k];
    const Index n = cosines.size();
    const Model plain = without_peaks(current.fit.own_noise.empty() ? current.fit.model.noise
                                                                    : current.fit.own_noise[k]);
    const Eigen::ArrayXd expected = plain.terms.empty() ? Eigen::ArrayXd(Eigen::ArrayXd::Ones(n))
                                                        : spectrum_of_cosines(plain, n + 1);
    for (Index b = 0; b < kWide; ++b) {
      const Index first = b * n / kWide;
      const Index length = (b + 1) * n / kWide - first;
      sum(b) +=
          (cosines.segment(first, length).array().square() / expected.segment(first, length)).sum();
      count(b) += static_cast<double>(length);
    }
  }
  return (sum / count).log();
}

// The lower edge of a course: a parabola that most of it lies above (asymmetric least squares,
// Newey & Powell 1987, Econometrica 55:819).
Eigen::ArrayXd lower_edge(const Eigen::ArrayXd& course) {
  constexpr double kAbove = 0.02;  // weight of what lies above, against 1 below
  constexpr int kRounds = 20;
  const Index n = course.size();
  const Eigen::ArrayXd at = Eigen::ArrayXd::LinSpaced(n, -1.0, 1.0);
  Eigen::MatrixXd basis(n, 3);
  basis << Eigen::VectorXd::Ones(n), at.matrix(), at.square().matrix();
  Eigen::ArrayXd weight = Eigen::ArrayXd::Ones(n);
  Eigen::ArrayXd out;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::MatrixXd weighted = basis.array().colwise() * weight;
    out = (basis * pseudo_inverse(Eigen::MatrixXd(weighted.transpose() * basis)).matrix *
           (weighted.transpose() * course.matrix()))
              .array();
    weight = (course > out).select(Eigen::ArrayXd::Constant(n, kAbove), Eigen::ArrayXd::Ones(n));
  }
  return out;
}

// Stretches of coefficients in a bump, at most 64.
struct BumpPart {
  Index first;
  Index length;
};

std::vector<BumpPart> parts_of(const NoiseBump& bump, Index coefficients) {
  constexpr Index kParts = 64;
  const Index first = place_of(bump.from, coefficients);
  const Index length = place_of(bump.to, coefficients) - first;
  std::vector<BumpPart> out;
  for (Index p = 0; p < kParts; ++p) {
    const Index begin = p * length / kParts;
    const Index end = (p + 1) * length / kParts;
    if (end > begin) out.push_back({first + begin, end - begin});
  }
  return out;
}

// Mean square of some coefficients.
double level_of(const VectorRef& cosines, Index first, Index last) {
  return cosines.segment(first, last - first).squaredNorm() / static_cast<double>(last - first);
}

}  // namespace

std::optional<NoiseBump> highest_bump(const Current& current) {
  constexpr Index kSlowest = 1;  // bands in which walks and slow waves lie
  // Least height over the lower edge, as a logarithm and in standard errors. Noise alone lies 1.7
  // standard errors above the edge.
  constexpr double kTop = 0.2;
  constexpr double kTopErrors = 7.0;
  constexpr double kSide = 0.04;
  constexpr double kSideErrors = 3.5;
  double samples = 0.0;
  for (const SharedVector& one : current.cosines) samples += static_cast<double>(one.size());
  const double error = std::sqrt(2.0 * static_cast<double>(kWide) / samples);
  const Eigen::ArrayXd ratio = log_ratio(current).tail(kWide - kSlowest);
  const Eigen::ArrayXd over = ratio - lower_edge(ratio);
  Index top = 0;
  if (!(over.maxCoeff(&top) > std::max(kTop, kTopErrors * error))) return std::nullopt;
  const double side = std::max(kSide, kSideErrors * error);
  Index first = top;
  Index last = top;
  while (first > 0 && over(first - 1) > side) --first;
  while (last + 1 < over.size() && over(last + 1) > side) ++last;
  if (first == 0 || last + 1 == over.size()) return std::nullopt;  // it has one side only
  const auto edge = [](Index band) {
    return 0.5 * static_cast<double>(band + kSlowest) / static_cast<double>(kWide);
  };
  return NoiseBump{edge(first - 1), edge(last + 2)};
}

Eigen::ArrayXd spectrum_beside(const Current& current, const NoiseBump& bump, std::size_t k) {
  const SharedVector& cosines = current.cosines[k];
  const Index n = cosines.size();
  const Index first = place_of(bump.from, n);
  const Index last = place_of(bump.to, n);
  const Index wide = std::max<Index>(1, n / kWide);
  Eigen::ArrayXd out = current.spectrum[k];
  for (Index b = 0; b < kWide; ++b) {
    const Index begin = b * n / kWide;
    const Index length = (b + 1) * n / kWide - begin;
    if (length == 0 || (begin < last && begin + length > first)) continue;
    out.segment(begin, length) *=
        (cosines.segment(begin, length).array().square() / out.segment(begin, length)).mean();
  }
  // The last band before and the first after may be cut: they take the level beside the edges.
  const Index before = std::max<Index>(0, first - wide);
  const Index after = std::min(n, last + wide);
  double low = before < first ? level_of(cosines, before, first) : 0.0;
  double high = last < after ? level_of(cosines, last, after) : 0.0;
  if (!(high > 0.0)) high = low;
  if (!(low > 0.0)) low = high;
  if (!(high > 0.0) || first == last) return out;
  const Index begin = std::max<Index>(0, first / wide * wide);
  const Index end = std::min(n, (last / wide + 1) * wide);
  const double slope = std::log(high / low);
  for (Index i = begin; i < end; ++i) {
    const double along =
        std::clamp(static_cast<double>(i - first) / static_cast<double>(last - first), 0.0, 1.0);
    out(i) = high * std::exp(-slope * (1.0 - along));
  }
  return out;
}

double wide_bands(const NoiseBump& bump) {
  return std::max(1.0, std::round(2.0 * static_cast<double>(kWide) * (bump.to - bump.from)));
}

Eigen::ArrayXd level_within(const VectorRef& cosines, const NoiseBump& bump) {
  const Index n = cosines.size();
  const Index first = place_of(bump.from, n);
  const Index length = place_of(bump.to, n) - first;
  Eigen::ArrayXd out = Eigen::ArrayXd::Ones(n);
  const auto bands = std::min(static_cast<Index>(wide_bands(bump)), length);
  if (bands == 0) return out;
  Eigen::ArrayXd level(bands);
  for (Index b = 0; b < bands; ++b)
    level(b) = level_of(cosines, first + b * length / bands, first + (b + 1) * length / bands);
  const double width = static_cast<double>(length) / static_cast<double>(bands);
  for (Index i = 0; i < length; ++i) {
    const double at = std::clamp((static_cast<double>(i) + 0.5) / width - 0.5, 0.0,
                                 static_cast<double>(bands - 1));
    const auto left = std::min(static_cast<Index>(at), std::max<Index>(0, bands - 2));
    const double along = at - static_cast<double>(left);
    out(first + i) = (1.0 - along) * level(left) + along * level(std::min(left + 1, bands - 1));
  }
  return out;
}

BumpTails tails_of(const Current& current, const NoiseBump& bump) {
  const std::size_t count = current.cosines.size();
  // Sums over a replicate, weighted by how many independent numbers its waves are.
  struct Sums {
    double independent = 0.0;
    double excess = 0.0;
    double of_tone = 0.0;
  };
  std::vector<Sums> sums(count);
  for_each_index(count, [&](std::size_t k) {
    const SharedVector& cosines = current.cosines[k];
    const Eigen::ArrayXd beside = spectrum_beside(current, bump, k);
    Eigen::VectorXd within = Eigen::VectorXd::Zero(cosines.size());
    double power = 0.0;
    double outstanding = 0.0;
    double squares = 0.0;
    for (const auto& [begin, many] : parts_of(bump, cosines.size())) {
      const double mean = level_of(cosines, begin, begin + many);
      // What stands out, by Wiener's filter.
      const double share = std::max(0.0, 1.0 - beside.segment(begin, many).mean() / mean);
      within.segment(begin, many) = share * cosines.segment(begin, many);
      const double left = share * share * mean;
      power += left * static_cast<double>(many);
      outstanding += share * left * static_cast<double>(many);
      squares += left * left * static_cast<double>(many);
    }
    if (!(squares > 0.0)) return;
    const Eigen::ArrayXd square = rough_inverse_cosine_transform(within).array().square();
    const double mean = square.mean();
    Sums& out = sums[k];
    out.independent = power * power / squares;
    out.excess = out.independent * (square.square().mean() / (mean * mean) - 3.0);
    out.of_tone = out.independent * -1.5 * std::pow(outstanding / power, 2.0);
  });
  Sums all;
  for (const Sums& one : sums) {
    all.independent += one.independent;
    all.excess += one.excess;
    all.of_tone += one.of_tone;
  }
  if (!(all.independent > 0.0)) return {};
  return {all.excess / all.independent, std::sqrt(24.0 / all.independent),
          all.of_tone / all.independent};
}

double alike_within(const Current& current, const NoiseBump& bump, const Witness& witness) {
  const auto quarter =
      static_cast<Index>(std::lround(0.5 / (bump.from + bump.to)));  // of a wave in the middle
  double chi = 0.0;
  for (std::size_t k = 0; k < current.cosines.size(); ++k) {
    const SharedVector& left = current.cosines[k];
    const SharedVector& other = witness.cosines[k];
    Eigen::VectorXd a = Eigen::VectorXd::Zero(left.size());
    Eigen::VectorXd b = Eigen::VectorXd::Zero(left.size());
    double variance = 0.0;  // of their product, if they are independent
    for (const auto& [first, length] : parts_of(bump, left.size())) {
      a.segment(first, length) = left.segment(first, length);
      b.segment(first, length) = other.segment(first, length);
      variance += a.segment(first, length).squaredNorm() * b.segment(first, length).squaredNorm() /
                  static_cast<double>(length);
    }
    if (!(variance > 0.0)) continue;
    a = rough_inverse_cosine_transform(a);
    b = rough_inverse_cosine_transform(b);
    const double at_once = a.dot(b);
    const Index both = std::max<Index>(0, a.size() - quarter);
    const double late = a.tail(both).dot(b.head(both));
    chi += (at_once * at_once + late * late) / variance;
  }
  return chi;
}

bool may_be_tone(const Current& current) {
  constexpr double kSurely = 3.0;  // standard errors
  const std::optional<NoiseBump> bump = highest_bump(current);
  if (!bump) return true;
  const BumpTails tails = tails_of(current, *bump);
  return tails.excess - tails.of_tone < kSurely * tails.error;
}

}  // namespace imunoise
