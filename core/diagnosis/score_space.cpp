#include "core/diagnosis/score_space.h"

#include <algorithm>
#include <cmath>

#include "core/estimate/whittle.h"
#include "core/inference/parameter_covariance.h"
#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// Of a unit vector: what is left of a spectrum that the parameters can make.
constexpr double kNothingNew = 1e-4;

}  // namespace

ScoreSpace::ScoreSpace(const Current& current) : pooled_(current.pooled) {
  const Model& noise = current.fit.model.noise;
  const std::vector<Index> interior = parameter_sets(noise).interior;
  Index rows = 0;
  for (const BandedPower& bands : pooled_) rows += bands.frequency.size();
  root_.resize(rows);
  excess_.resize(rows);
  slopes_.resize(rows, static_cast<Index>(interior.size()));
  Index begin = 0;
  for (const BandedPower& bands : pooled_) {
    const Index size = bands.frequency.size();
    const Eigen::ArrayXd s = spectrum(noise, bands.frequency);
    root_.segment(begin, size) = (0.5 * bands.count).sqrt() / s;
    excess_.segment(begin, size) = (root_.segment(begin, size) * (bands.power - s)).matrix();
    slopes_.middleRows(begin, size) = whittle_slopes(noise, bands, interior);
    begin += size;
  }
  inverse_ = pseudo_inverse(slopes_.transpose() * slopes_).matrix;
}

Eigen::VectorXd ScoreSpace::direction(const Process& process) const {
  const Eigen::VectorXd unit = whitened(process).normalized();
  return unit - slopes_ * (inverse_ * (slopes_.transpose() * unit));
}

double ScoreSpace::score(const Eigen::VectorXd& direction) const {
  const double norm = direction.norm();
  return norm > kNothingNew ? direction.dot(excess_) / norm : 0.0;
}

double ScoreSpace::precision(const Process& process) const {
  return whitened(process).norm() * std::max(direction(process).norm(), kNothingNew);
}

// A spectrum over that of the model, as its power moves the whitened band powers.
Eigen::VectorXd ScoreSpace::whitened(const Process& process) const {
  Eigen::VectorXd out(root_.size());
  Index begin = 0;
  for (const BandedPower& bands : pooled_) {
    const Index size = bands.frequency.size();
    out.segment(begin, size) =
        (root_.segment(begin, size) * spectrum(process, bands.frequency)).matrix();
    begin += size;
  }
  return out;
}

void add_best(const Current& current, const ScoreSpace& space, std::string_view cause,
              const std::vector<Process>& family, Suggestions& out) {
  if (family.empty()) return;  // replicates are too short for any of it
  Eigen::MatrixXd directions(space.direction(family[0]).size(), static_cast<Index>(family.size()));
  std::size_t best = 0;
  double most = -INFINITY;
  for (std::size_t i = 0; i < family.size(); ++i) {
    directions.col(static_cast<Index>(i)) = space.direction(family[i]);
    const double score = space.score(directions.col(static_cast<Index>(i)));
    if (score <= most) continue;
    most = score;
    best = i;
  }
  Process process = family[best];
  std::vector<double> v = values(process);
  const double precision = space.precision(process);
  v[0] = std::max(most, 1.0) / precision;
  set_values(process, v);
  Model grown = current.fit.model.noise;
  grown.terms.emplace_back(process);
  out.push_back({.cause = cause,
                 .added = NoiseChange{std::move(grown), process},
                 .score_nats = most > 0.0 ? 0.5 * most * most : 0.0,
                 .power = true,
                 .search = {.path = path_length(directions)},
                 .information = precision * precision});
}

}  // namespace imunoise
