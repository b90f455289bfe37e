#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "core/diagnosis/peak.h"
#include "core/diagnosis/scan.h"
#include "core/spectrum/cosine_transform.h"
#include "core/spectrum/fourier.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// A wave of fewer periods than this in a replicate is a trend like any other.
constexpr double kFewestPeriods = 8.0;

// The shortest quick length ≥ n.
Index padded_length(Index n) {
  auto out = static_cast<std::size_t>(n);
  while (quick_length(out) != out) ++out;
  return static_cast<Index>(out);
}

double level_at(const Current& current, std::size_t k, double f) {
  const Eigen::ArrayXd& s = current.spectrum[k];
  const auto place = static_cast<Index>(std::lround(2.0 * f * static_cast<double>(s.size() + 1)));
  return s(std::clamp<Index>(place - 1, 0, s.size() - 1));
}

// Log-likelihood gained by a wave of any phase and size in a replicate, at frequencies i/2N.
Eigen::ArrayXd gains(const Current& current, std::size_t k, Index padded) {
  const Eigen::VectorXd& u = current.weighted[k];
  std::vector<double> series(static_cast<std::size_t>(padded), 0.0);
  std::copy(u.data(), u.data() + u.size(), series.begin());
  const std::vector<std::complex<double>> spectrum = half_spectrum(std::move(series));
  Eigen::ArrayXd out(static_cast<Index>(spectrum.size()));
  for (Index i = 0; i < out.size(); ++i) {
    const double f = static_cast<double>(i) / static_cast<double>(padded);
    out(i) = std::norm(spectrum[static_cast<std::size_t>(i)]) * level_at(current, k, f) /
             static_cast<double>(u.size());
  }
  return out;
}

// The same at one frequency, cycles per sample, over all replicates.
double gain_at(const Current& current, double f) {
  double out = 0.0;
  for (std::size_t k = 0; k < current.weighted.size(); ++k) {
    const Eigen::VectorXd& u = current.weighted[k];
    const std::complex<double> turn = std::polar(1.0, -2.0 * std::numbers::pi * f);
    std::complex<double> sum = 0.0;
    for (Index t = u.size() - 1; t >= 0; --t) sum = sum * turn + u(t);
    out += std::norm(sum) * level_at(current, k, f) / static_cast<double>(u.size());
  }
  return out;
}

// True where a frequency is that of 50 or 60 Hz mains or of a low multiple, folded; mains wander by
// 0.1 %.
bool is_folded_mains(double hertz, double rate, double resolution) {
  for (const double mains : {50.0, 60.0}) {
    for (int multiple = 1; multiple <= 4; ++multiple) {
      const double high = mains * multiple;
      if (high < 0.5 * rate) continue;
      const double folded = std::abs(high - rate * std::round(high / rate));
      if (folded > 0.0 && std::abs(folded - hertz) <= 0.001 * high + resolution) return true;
    }
  }
  return false;
}

}  // namespace

Suggestions scan_lines(const Current& current) {
  const Subject& subject = current.subject();
  Index longest = 0;
  Index shortest = subject.length(0);
  for (std::size_t k = 0; k < subject.replicates(); ++k) {
    longest = std::max(longest, subject.length(k));
    shortest = std::min(shortest, subject.length(k));
  }
  const Index padded = padded_length(2 * longest);
  std::vector<Eigen::ArrayXd> each(subject.replicates());
  for_each_index(each.size(), [&](std::size_t k) { each[k] = gains(current, k, padded); });
  Eigen::ArrayXd sum = each[0];
  for (std::size_t k = 1; k < each.size(); ++k) sum += each[k];
  const auto first = static_cast<Index>(
      std::ceil(kFewestPeriods * static_cast<double>(padded) / static_cast<double>(shortest)));
  if (first >= sum.size() - 2) return {};
  Index best = first;
  sum.segment(first, sum.size() - 1 - first).maxCoeff(&best);
  best += first;
  const double step = 1.0 / static_cast<double>(padded);
  const double near = static_cast<double>(best) * step;
  const Peak peak = peak_between(near - step, near + step, 0.25 * step,
                                 [&](double at) { return gain_at(current, at); });
  const double f = peak.at;
  const double rate = subject.rate.value;

  Suggestion line{.effect = "line",
                  .added = EffectTerm{.kind = EffectKind::kLine, .frequency = f * rate},
                  .score_nats = peak.gain,
                  .dof = 2.0 * static_cast<double>(each.size()),
                  .shape_error = peak.error * rate};
  for (std::size_t k = 0; k < each.size(); ++k)
    line.information += 0.5 * static_cast<double>(subject.length(k)) / level_at(current, k, f);
  // A wave's score turns by π T/√3 rad per Hz: the spread of time within a replicate.
  line.search.path = 0.5 * std::numbers::pi / std::sqrt(3.0) * static_cast<double>(longest);
  const double resolution = rate / static_cast<double>(longest);
  if (is_folded_mains(f * rate, rate, resolution)) line.effect = "mains_alias";
  Suggestions out{line};

  // Multiples of a fundamental, which may be any of the first four of them.
  for (int order = 1; order <= 4; ++order) {
    const double fundamental = f / order;
    const int most = std::min(12, static_cast<int>(0.495 / fundamental));
    if (fundamental * static_cast<double>(shortest) < kFewestPeriods || most < 2) continue;
    double total = 0.0;
    double kept = 0.0;
    int count = 0;
    int seen = 0;
    for (int h = 1; h <= most; ++h) {
      const double gain = h == order ? line.score_nats : gain_at(current, h * fundamental);
      total += gain;
      constexpr double kSeenNats = 6.0;
      if (gain < kSeenNats + 0.5 * line.dof) continue;
      ++seen;
      kept = total;
      count = h;
    }
    if (seen < 2 || 2 * seen < count) continue;
    Suggestion harmonics{.effect = "harmonics",
                         .added = EffectTerm{.kind = EffectKind::kLine,
                                             .frequency = fundamental * rate,
                                             .harmonics = static_cast<double>(count)},
                         .score_nats = kept,
                         .dof = line.dof * count,
                         .search = line.search,
                         .shape_error = line.shape_error / order};
    harmonics.search.log_places = std::log(4.0 * most);
    out.push_back(std::move(harmonics));
    break;
  }
  return out;
}

}  // namespace imunoise
