#include "study/export/power_on.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/process/parameter_scale.h"
#include "core/support/random.h"
#include "core/support/rough.h"
#include "study/analysis/vocabulary.h"
#include "study/words/number.h"

namespace imunoise::study {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr std::size_t kDraws = 2000;

double student(RandomStream& rng, int degrees) {
  const double z = rng.normal();
  double chi2 = 0.0;
  for (int i = 0; i < degrees; ++i) {
    const double one = rng.normal();
    chi2 += one * one;
  }
  return z / std::sqrt(chi2 / degrees);
}

Model drawn(Model noise, const std::vector<ParameterDraw>& draws, RandomStream& rng) {
  for (const ParameterDraw& one : draws) {
    Process& process = noise.terms[one.term].process;
    std::vector<double> all = values(process);
    const ParameterScale scale(parameters(process)[one.parameter], one.parameter);
    const double wide = std::sqrt(1.0 + 1.0 / one.replicates) * one.spread;
    all[one.parameter] =
        scale.to_value(scale.to_scale(one.mean) + wide * student(rng, one.replicates - 1));
    set_values(process, all);
  }
  return noise;
}

}  // namespace

std::vector<ParameterDraw> moving_parameters(
    const Model& noise, const google::protobuf::RepeatedPtrField<v1::ParameterSpread>& spread) {
  std::vector<ParameterDraw> out;
  for (const v1::ParameterSpread& from : spread) {
    if (!from.moves() || from.replicates() < 3) continue;
    for (std::size_t t = 0; t < noise.terms.size(); ++t) {
      const std::vector<ParameterInfo> about = parameters(noise.terms[t].process);
      const auto found = std::find_if(about.begin(), about.end(), [&](const ParameterInfo& one) {
        return one.name == from.parameter();
      });
      if (label_of(noise, t) != from.term() || found == about.end()) continue;
      out.push_back(
          {t, static_cast<std::size_t>(found - about.begin()), from.mean(), from.relative(),
           static_cast<int>(from.replicates()),
           fmt::format("{} of {}: typically {}, between {} replicates ±{} % ({} … {} %)",
                       from.parameter(), from.term(),
                       report::brief(from.mean(), 3, report::Digits::kPlain), from.replicates(),
                       rough(100.0 * from.relative()), rough(100.0 * from.relative_lower()),
                       rough(100.0 * from.relative_upper()))});
    }
  }
  return out;
}

Eigen::ArrayXd power_on_allan(const Model& noise, const std::vector<ParameterDraw>& draws,
                              const Eigen::ArrayXd& samples, double level) {
  RandomStream rng(kSeed);
  Eigen::ArrayXXd all(samples.size(), static_cast<Eigen::Index>(kDraws));
  for (Eigen::Index i = 0; i < all.cols(); ++i)
    all.col(i) = 2.0 * variance(drawn(noise, draws, rng), samples);
  Eigen::ArrayXd out(samples.size());
  const auto at = static_cast<Eigen::Index>(std::ceil(level * static_cast<double>(kDraws))) - 1;
  for (Eigen::Index m = 0; m < all.rows(); ++m) {
    std::vector<double> row(kDraws);
    Eigen::Map<Eigen::ArrayXd>(row.data(), all.cols()) = all.row(m).transpose();
    std::nth_element(row.begin(), row.begin() + at, row.end());
    out(m) = row[static_cast<std::size_t>(at)];
  }
  return out;
}

}  // namespace imunoise::study
