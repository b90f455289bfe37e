#include "core/diagnosis/views/misfit.h"

#include <algorithm>
#include <cmath>

#include "core/diagnosis/views/efficient_residuals.h"
#include "core/diagnosis/views/normal_power.h"
#include "core/effect/converter_steps.h"
#include "core/inference/parameter_covariance.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// Bands are put together until they have this many degrees of freedom and span half an octave.
constexpr double kFewestDof = 8.0;

// What the model leaves in each replicate; over noise of its own, as if that were what all share.
std::vector<BandedPower> as_shared(const FittedModel& fitted) {
  const Regression& regression = fitted.regression;
  std::vector<BandedPower> out = regression.residual(fitted.fit.effects.value);
  if (fitted.fit.own_noise.empty()) return out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Model& own = fitted.fit.own_noise[regression.replicates()[i]];
    out[i].power *=
        spectrum(fitted.fit.model.noise, out[i].frequency) / spectrum(own, out[i].frequency);
  }
  return out;
}

// What the replicates of one length say about a narrow band.
struct Measured {
  double frequency = 0.0;  // Hz
  double dof = 0.0;
  double relative = 0.0;  // sum of as many powers over the model's
  Eigen::VectorXd slope;  // of the model's logarithm, by its parameters
};

// Of replicates of all lengths, in the order of frequency.
std::vector<Measured> measured(const Model& noise, const std::vector<BandedPower>& lengths,
                               const std::vector<Index>& interior) {
  std::vector<Measured> out;
  for (const BandedPower& bands : lengths) {
    const Eigen::MatrixXd slopes = whittle_slopes(noise, bands, interior);
    const Eigen::ArrayXd power = bands.count * bands.power / spectrum(noise, bands.frequency);
    for (Index b = 0; b < bands.frequency.size(); ++b) {
      out.push_back({bands.frequency(b) * bands.rate.value, bands.count(b), power(b),
                     slopes.row(b).transpose()});
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const Measured& one, const Measured& other) {
    return one.frequency < other.frequency;
  });
  return out;
}

// Half octaves, with the directions of the parameters.
void add_bands(const std::vector<Measured>& all, std::vector<BandMisfit>& out,
               std::vector<Eigen::VectorXd>& directions) {
  for (std::size_t begin = 0; begin < all.size();) {
    double dof = 0.0;
    double relative = 0.0;
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(all[begin].slope.size());
    std::size_t end = begin;
    while (end < all.size() &&
           (dof < kFewestDof || all[end].frequency < std::sqrt(2.0) * all[begin].frequency)) {
      dof += all[end].dof;
      relative += all[end].relative;
      direction += std::sqrt(0.5 * all[end].dof) * all[end].slope;
      ++end;
    }
    if (dof >= kFewestDof) {
      BandMisfit one{all[begin].frequency, all[end - 1].frequency, relative / dof, 0.0, 0, dof};
      one.sigma = normal_score(one.ratio, dof);
      out.push_back(one);
      directions.push_back(direction / std::sqrt(0.5 * dof));
    }
    begin = end;
  }
}

void count_replicates(const Model& noise, const std::vector<BandedPower>& left,
                      std::vector<BandMisfit>& bands) {
  for (const BandedPower& one : left) {
    const Eigen::ArrayXd power = one.count * one.power / spectrum(noise, one.frequency);
    for (BandMisfit& band : bands) {
      double dof = 0.0;
      double relative = 0.0;
      for (Index b = 0; b < one.frequency.size(); ++b) {
        const double f = one.frequency(b) * one.rate.value;
        if (f < band.from || f > band.to) continue;
        dof += one.count(b);
        relative += power(b);
      }
      if (dof > 0.0 && (relative > dof) == (band.ratio > 1.0)) ++band.replicates;
    }
  }
}

}  // namespace

MisfitReport misfit_of(const FittedModel& fitted) {
  MisfitReport out;
  const Model& noise = fitted.fit.model.noise;
  const Subject& subject = fitted.regression.subject();
  const std::vector<BandedPower> remaining = as_shared(fitted);
  const std::vector<Index> interior = parameter_sets(noise).interior;
  std::vector<Eigen::VectorXd> directions;
  add_bands(measured(noise, pooled(remaining), interior), out.bands, directions);
  count_replicates(noise, remaining, out.bands);
  const auto n = static_cast<Index>(out.bands.size());
  Eigen::VectorXd z(n);
  Eigen::MatrixXd a(n, static_cast<Index>(interior.size()));
  for (Index i = 0; i < n; ++i) {
    z(i) = out.bands[static_cast<std::size_t>(i)].sigma;
    a.row(i) = directions[static_cast<std::size_t>(i)].transpose();
  }
  out.spectrum = test_after_fit(z, a, whittle_information(noise, pooled(remaining), interior));

  // One replicate after the other: all their innovations at once would be as long as the recording.
  struct Seen {
    std::vector<TimeMisfit> times;
    double squares = 0.0;
    double fourth = 0.0;
    double samples = 0.0;
  };
  const std::vector<std::size_t>& replicates = fitted.regression.replicates();
  std::vector<Seen> each(replicates.size());
  for_each_index(each.size(), [&](std::size_t i) {
    const std::size_t k = replicates[i];
    const Eigen::VectorXd white = innovations(fitted.regression, fitted.fit, k);
    each[i] = {time_misfits(white, k, subject.rate.value), white.squaredNorm(),
               white.array().square().square().sum(), static_cast<double>(white.size())};
  });
  double chi = 0.0;
  double squares = 0.0;
  double fourth = 0.0;
  double samples = 0.0;
  double within = 0.0;
  for (std::size_t i = 0; i < each.size(); ++i) {
    const Seen& one = each[i];
    const double power = one.squares / one.samples;
    out.powers.push_back({replicates[i], power, one.samples});
    if (power > 0.0) within += one.fourth / (power * power);
    for (const TimeMisfit& stretch : one.times) chi += stretch.sigma * stretch.sigma;
    out.times.insert(out.times.end(), one.times.begin(), one.times.end());
    squares += one.squares;
    fourth += one.fourth;
    samples += one.samples;
  }
  out.time = chi_square_test(chi, static_cast<Index>(out.times.size() - each.size()));
  const ConverterSteps steps = converter_steps(subject);
  if (!steps.is_coarse()) {
    const double normal = 3.0 + steps.excess_kurtosis(innovation_deviation(noise));
    out.excess_kurtosis = fourth * samples / (squares * squares) - normal;
    out.excess_within_replicates = within / samples - normal;
    out.kurtosis = chi_square_test(*out.excess_kurtosis * *out.excess_kurtosis * samples / 24.0, 1);
  }
  return out;
}

std::vector<TimeMisfit> time_misfits(const VectorRef& white, std::size_t replicate, double rate) {
  constexpr Index kStretches = 16;
  std::vector<TimeMisfit> out;
  const Index length = white.size() / kStretches;
  // Each replicate against its own level: that is another question.
  const double level = white.squaredNorm() / static_cast<double>(white.size());
  const double seconds = static_cast<double>(length) / rate;
  for (Index at = 0; at < kStretches; ++at) {
    const double ratio =
        white.segment(at * length, length).squaredNorm() / (level * static_cast<double>(length));
    out.push_back({replicate, static_cast<double>(at) * seconds,
                   static_cast<double>(at + 1) * seconds, ratio,
                   normal_score(ratio, static_cast<double>(length))});
  }
  return out;
}

double misfit_p_value(const MisfitReport& misfit) {
  const double least =
      std::min({misfit.spectrum.p_value, misfit.time.p_value, misfit.kurtosis.p_value});
  return 1.0 - std::pow(1.0 - least, 3.0);
}

double promised_nats(const MisfitReport& misfit) {
  constexpr double kOnceInAHundred = 0.01;
  if (!(misfit_p_value(misfit) < kOnceInAHundred)) return 0.0;
  double out = 0.0;
  for (const TestOutcome& one : {misfit.spectrum, misfit.time})
    out = std::max(out, 0.5 * one.statistic - static_cast<double>(one.degrees_of_freedom));
  return out;
}

}  // namespace imunoise
