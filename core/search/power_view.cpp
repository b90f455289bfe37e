#include "core/search/power_view.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/estimate/whittle.h"
#include "core/regression/joint_fit.h"
#include "core/spectrum/cosine_transform.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr Index kPowerStretch = 32;              // samples
constexpr double kChance = 0.06449378348136886;  // trigamma(16): variance of log χ²_32
constexpr Index kFewestStretches = 16;
constexpr double kWanders = 3.0;  // nats: less may be chance

// Means over the stretches of a replicate.
Eigen::VectorXd stretch_means(const VectorRef& x, Index count) {
  Eigen::VectorXd out(count);
  for (Index i = 0; i < count; ++i) out(i) = x.segment(i * kPowerStretch, kPowerStretch).mean();
  return out;
}

Model white_power(double variance, bool given) {
  Term white(Process(WhiteNoise{variance}));
  white.given[0] = given;
  return {{white}};
}

// White noise, and a Markov process of some variance.
Model wandering_power(const Model& white, double variance, double phi, bool given) {
  Model out = white;
  Term markov(Process(Ar1{variance * (1.0 - phi * phi), phi}));
  markov.given[1] = given;
  out.terms.push_back(markov);
  return out;
}

// The Markov process of a fit; the fit sorts its terms.
const Ar1& markov_of(const Model& noise) {
  const auto found = std::find_if(noise.terms.begin(), noise.terms.end(), [](const Term& term) {
    return std::holds_alternative<Ar1>(term.process);
  });
  return std::get<Ar1>(found->process);
}

double white_of(const Model& noise) {
  for (const Term& term : noise.terms) {
    if (const auto* white = std::get_if<WhiteNoise>(&term.process)) return white->sigma2;
  }
  return 0.0;
}

// Variance of the mean of n numbers of a Markov process of variance 1, times n.
double of_mean(double phi, double n) {
  return (1.0 + phi) / (1.0 - phi) -
         2.0 * phi * (1.0 - std::pow(phi, n)) / (n * (1.0 - phi) * (1.0 - phi));
}

BandedPower power_of(const Eigen::VectorXd& x) {
  const std::span<const double> all(x.data(), static_cast<std::size_t>(x.size()));
  return banded_power(Signal(all, Hertz{1.0}));
}

}  // namespace

std::optional<PowerView> PowerView::of(const Innovations& innovations) {
  PowerView out;
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < innovations.white.size(); ++i) {
    const Eigen::VectorXd& y = innovations.white[i];
    if (y.size() / kPowerStretch < kFewestStretches) return std::nullopt;
    const auto n =
        static_cast<Index>(quick_length(static_cast<std::size_t>(y.size() / kPowerStretch)));
    const Eigen::ArrayXd power = stretch_means(y.array().square().matrix(), n).array();
    if (!(power > 0.0).all()) return std::nullopt;
    Eigen::VectorXd logarithm = power.log().matrix();
    const double level = logarithm.mean();
    logarithm.array() -= level;
    squares += logarithm.squaredNorm();
    count += static_cast<double>(n);
    Eigen::VectorXd cosines = cosine_transform(logarithm);
    out.replicates_.push_back(
        {innovations.replicates[i], level, std::move(logarithm), std::move(cosines)});
  }
  if (!(squares > 0.0)) return std::nullopt;
  out.chance_ = out.fitted(white_power(kChance, true), nullptr);
  out.constant_ = out.fitted(white_power(squares / count, false), nullptr);
  out.wander_ = out.wandering(nullptr);
  return out;
}

std::vector<Eigen::VectorXd> PowerView::stretched(const VarianceCourse& course) const {
  std::vector<Eigen::VectorXd> out;
  for (const Replicate& one : replicates_) {
    out.push_back(stretch_means(course[one.number], one.power.size()));
    out.back().array() -= out.back().mean();
  }
  return out;
}

PowerView::Fit PowerView::fitted(const Model& start,
                                 const std::vector<Eigen::VectorXd>* course) const {
  constexpr int kTurns = 4;
  Fit out{start};
  double slope = 0.0;
  for (int turn = 0; turn < (course == nullptr ? 1 : kTurns); ++turn) {
    if (course != nullptr) {
      double product = 0.0;
      double square = 0.0;
      for (std::size_t i = 0; i < replicates_.size(); ++i) {
        const Eigen::ArrayXd c = cosine_transform((*course)[i]).array();
        const Eigen::ArrayXd weighted = c / spectrum_of_cosines(out.noise, c.size() + 1);
        product += (weighted * replicates_[i].cosines.array()).sum();
        square += (weighted * c).sum();
      }
      slope = square > 0.0 ? product / square : 0.0;
    }
    std::vector<BandedPower> left;
    for (std::size_t i = 0; i < replicates_.size(); ++i) {
      const Eigen::VectorXd& power = replicates_[i].power;
      left.push_back(power_of(course == nullptr ? power : power - slope * (*course)[i]));
    }
    const WhittleEstimate found = whittle(out.noise, left);
    out.noise = found.model;
    out.log_likelihood = -found.objective;
  }
  return out;
}

PowerView::Fit PowerView::wandering(const std::vector<Eigen::VectorXd>* course) const {
  const double all = white_of(constant_.noise);
  const double variance = 0.2 * all;
  const Model white = white_power(all - variance, false);
  Fit best;
  best.log_likelihood = -INFINITY;
  const auto longest = static_cast<double>(replicates_.front().power.size()) / 4.0;
  for (const double time : std::array{3.0, std::sqrt(3.0 * longest), longest}) {
    Fit one = fitted(wandering_power(white, variance, std::exp(-1.0 / time), false), course);
    if (one.log_likelihood > best.log_likelihood) best = std::move(one);
  }
  return best;
}

PowerView::Explained PowerView::explained(const VarianceCourse& course) const {
  const std::vector<Eigen::VectorXd> means = stretched(course);
  const double chance = fitted(chance_.noise, &means).log_likelihood;
  const double wander = wandering(&means).log_likelihood;
  return {.gain = wander - wander_.log_likelihood,
          .alone = chance - chance_.log_likelihood,
          .steady = wander - chance < kWanders};
}

double PowerView::wander_gain() const { return wander_.log_likelihood - constant_.log_likelihood; }

PowerView::Spread PowerView::of_means() const {
  if (wander_.log_likelihood - chance_.log_likelihood < kWanders) return {1.0, INFINITY};
  const Ar1& markov = markov_of(wander_.noise);
  const double phi = std::clamp(markov.phi, 0.0, 1.0 - 1e-9);
  const double variance = markov.sigma2 / (1.0 - phi * phi);
  const double n = mean_length();
  const double all = n * static_cast<double>(replicates_.size());
  const double wandering = variance * of_mean(phi, n);
  const double white = white_of(wander_.noise);
  // A number of its own every two correlation times (Satterthwaite 1946).
  const double own = std::max(1.0, 0.5 * all * -std::log(std::max(1e-6, phi)));
  const double total = white + wandering;
  return {std::max(1.0, total / kChance),
          total * total / (white * white / all + wandering * wandering / own)};
}

double PowerView::mean_length() const {
  double all = 0.0;
  for (const Replicate& one : replicates_) all += static_cast<double>(one.power.size());
  return all / static_cast<double>(replicates_.size());
}

bool PowerView::rules_out_wander() const {
  const auto count = static_cast<double>(replicates_.size());
  const double n = mean_length();
  double mean = 0.0;
  for (const Replicate& one : replicates_) mean += one.level / count;
  double variance = 0.0;  // of the levels, beyond chance
  for (const Replicate& one : replicates_) {
    const double chance = kChance / static_cast<double>(one.power.size());
    variance += (one.level - mean) * (one.level - mean) / (count - 1.0) - chance / count;
  }
  if (!(variance > 0.0)) return false;
  const double phi = std::exp(-1.0 / n);
  Model wandering = wandering_power(constant_.noise, variance * n / of_mean(phi, n), phi, true);
  wandering.terms.back().given[0] = true;
  return constant_.log_likelihood - fitted(wandering, nullptr).log_likelihood > kWanders;
}

}  // namespace imunoise
