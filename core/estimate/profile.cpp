#include "core/estimate/profile.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/model/trend.h"
#include "core/support/linear_algebra.h"

namespace imunoise {

namespace {

bool solved_by_ends(const Term& term) { return term.trends[0].link == Link::kLinear; }

}  // namespace

double Profile::Coordinate::to_search(double value) const {
  return slope ? value : scale().to_scale(std::clamp(value, info.lower, info.upper));
}

double Profile::Coordinate::to_value(double search) const {
  return slope ? search : std::clamp(scale().to_value(search), info.lower, info.upper);
}

double Profile::Coordinate::lower() const {
  return slope ? -kSteepestTrend : to_search(info.lower);
}

double Profile::Coordinate::upper() const { return slope ? kSteepestTrend : to_search(info.upper); }

Profile::Profile(const Problem& problem) : problem_(problem) {
  for (std::size_t t = 0; t < problem.model.terms.size(); ++t) {
    const Term& term = problem.model.terms[t];
    const std::vector<ParameterInfo> about = parameters(term.process);
    if (!term.given[0]) {
      const auto matrix = problem.matrix_powers.find(t);
      const Eigen::Index size = matrix == problem.matrix_powers.end() ? 1 : matrix->second;
      assert(size == 1 || !varies(term));
      const Eigen::Index columns = solved_by_ends(term) ? 2 : packed_size(size);
      free_powers_.push_back({t, size, free_columns_, columns});
      free_columns_ += columns;
    }
    for (std::size_t p = 0; p < about.size(); ++p) {
      if (term.given[p]) continue;
      const Link link = term.trends[p].link;
      if (p > 0) coordinates_.push_back({t, p, about[p]});
      if (link == Link::kExponential || link == Link::kLogistic) {
        coordinates_.push_back({t, p, about[p], true});
      }
    }
  }
  for (const MomentBlock& block : problem.blocks) {
    rows_ += block.weight_root.rows();
    std::vector<std::size_t> site_of;
    for (const Segment& segment : block.segments) {
      Site site{segment.scales.half_widths(), segment.covariate};
      const auto found = std::find(sites_.begin(), sites_.end(), site);
      site_of.push_back(static_cast<std::size_t>(found - sites_.begin()));
      if (found == sites_.end()) sites_.push_back(std::move(site));
    }
    site_of_.push_back(std::move(site_of));
  }
  measured_.resize(rows_);
  Eigen::Index row = 0;
  for (const MomentBlock& block : problem.blocks) {
    measured_.segment(row, block.weight_root.rows()) = block.weight_root * block.measured;
    row += block.weight_root.rows();
  }
}

Eigen::VectorXd Profile::whitened(Share share, const std::vector<Eigen::ArrayXd>& per_site) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(rows_);
  Eigen::Index row = 0;
  for (std::size_t b = 0; b < problem_.blocks.size(); ++b) {
    const MomentBlock& block = problem_.blocks[b];
    const Eigen::Index rows = block.weight_root.rows();
    Eigen::Index moment = 0;
    for (std::size_t s = 0; s < block.segments.size(); ++s) {
      const Segment& segment = block.segments[s];
      const Eigen::ArrayXd& values = per_site[site_of_[b][s]];
      if (std::find(segment.shares.begin(), segment.shares.end(), share) != segment.shares.end()) {
        out.segment(row, rows) +=
            block.weight_root.middleCols(moment, values.size()) * values.matrix();
      }
      moment += values.size();
    }
    row += rows;
  }
  return out;
}

Eigen::VectorXd Profile::column(Share share, const Process& process) const {
  std::vector<Eigen::ArrayXd> shapes;
  for (const Site& site : sites_) shapes.push_back(shape(process, site.half_widths));
  return whitened(share, shapes);
}

// What a power contributes when it is 1: a number in the middle of the covariate's range, one of
// its ends, or an entry of a matrix.
Eigen::VectorXd Profile::column(const FreePower& power, Eigen::Index index,
                                const Term& term) const {
  std::vector<Eigen::ArrayXd> shapes;
  for (const Site& site : sites_) {
    const Trend& trend = term.trends[0];
    double share = 1.0;
    if (trend.link == Link::kExponential) share = std::exp(trend.slope * site.covariate);
    if (trend.link == Link::kLinear) {
      share = 0.5 * (index == 0 ? 1.0 - site.covariate : 1.0 + site.covariate);
    }
    shapes.emplace_back(share * shape(process_at(term, site.covariate), site.half_widths));
  }
  return whitened({power.term, solved_by_ends(term) ? 0 : index}, shapes);
}

Eigen::VectorXd Profile::target(const Model& model) const {
  Eigen::VectorXd out = measured_;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    const Term& term = model.terms[t];
    if (!term.given[0]) continue;
    std::vector<Eigen::ArrayXd> explained;
    for (const Site& site : sites_) {
      explained.push_back(variance(process_at(term, site.covariate), site.half_widths));
    }
    out -= whitened({t, 0}, explained);
  }
  return out;
}

std::vector<double> Profile::coordinates_of(const Model& model) const {
  std::vector<double> out;
  for (const Coordinate& c : coordinates_) {
    const Term& term = model.terms[c.term];
    out.push_back(c.slope ? term.trends[c.parameter].slope
                          : c.to_search(values(term.process)[c.parameter]));
  }
  return out;
}

Model Profile::model_of(const std::vector<double>& x) const {
  Model model = problem_.model;
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const Coordinate& c = coordinates_[i];
    Term& term = model.terms[c.term];
    if (c.slope) {
      term.trends[c.parameter].slope = x[i];
      continue;
    }
    std::vector<double> v = values(term.process);
    v[c.parameter] = c.to_value(x[i]);
    set_values(term.process, v);
  }
  return model;
}

Profile::Point Profile::at(const std::vector<double>& x, std::vector<double>* gradient) const {
  Model model = model_of(x);
  Eigen::MatrixXd columns(rows_, free_columns_);
  for (const FreePower& power : free_powers_) {
    for (Eigen::Index i = 0; i < power.columns; ++i) {
      columns.col(power.begin + i) = column(power, i, model.terms[power.term]);
    }
  }
  const Eigen::VectorXd wanted = target(model);
  const Eigen::VectorXd powers = solve(columns, wanted);
  const Eigen::VectorXd residual = wanted - columns * powers;
  Point point{std::move(model), {}, residual.squaredNorm()};
  set_powers(powers, point);
  for (std::size_t i = 0; gradient != nullptr && i < coordinates_.size(); ++i) {
    const Coordinate& c = coordinates_[i];
    (*gradient)[i] = derivative(c, point.model.terms[c.term], powers, residual);
  }
  return point;
}

// dQ/dη = -2 rᵀ W Σ d(power · shape)/dη: by the envelope theorem the powers that are solved for
// stay as they are.
double Profile::derivative(const Coordinate& coordinate, const Term& term,
                           const Eigen::VectorXd& powers, const Eigen::VectorXd& residual) const {
  std::vector<Eigen::ArrayXd> changes;
  for (const Site& site : sites_) {
    const double along = coordinate.slope ? site.covariate : 1.0;
    changes.emplace_back(along *
                         change_with(term, coordinate.parameter, site.covariate, site.half_widths));
  }
  const auto matrix = std::find_if(free_powers_.begin(), free_powers_.end(), [&](const auto& p) {
    return p.term == coordinate.term && p.size > 1;
  });
  if (matrix == free_powers_.end()) {
    return -2.0 * residual.dot(whitened({coordinate.term, 0}, changes));
  }
  double sum = 0.0;
  for (Eigen::Index e = 0; e < matrix->columns; ++e) {
    const double power = powers(matrix->begin + e);
    if (power != 0.0) sum += power * residual.dot(whitened({coordinate.term, e}, changes));
  }
  return -2.0 * sum;
}

// The powers that minimise |target - columns·powers|², each number non-negative and each matrix
// positive semidefinite.
Eigen::VectorXd Profile::solve(const Eigen::MatrixXd& columns,
                               const Eigen::VectorXd& target) const {
  std::vector<Eigen::Index> sizes;
  for (const FreePower& power : free_powers_) sizes.push_back(power.size);
  return conic_least_squares(columns.transpose() * columns, columns.transpose() * target, sizes);
}

void Profile::set_powers(const Eigen::VectorXd& powers, Point& point) const {
  for (const FreePower& power : free_powers_) {
    Term& term = point.model.terms[power.term];
    std::vector<double> v = values(term.process);
    const bool matrix = problem_.matrix_powers.contains(power.term);
    v[0] = matrix ? 1.0 : powers(power.begin);
    if (solved_by_ends(term)) {
      const double last = powers(power.begin + 1);
      term.trends[0].slope = 0.5 * (last - v[0]);
      v[0] = 0.5 * (last + v[0]);
    }
    set_values(term.process, v);
    if (!matrix) continue;
    Eigen::MatrixXd full(power.size, power.size);
    for (Eigen::Index i = 0; i < power.size; ++i) {
      for (Eigen::Index j = 0; j < power.size; ++j) {
        full(i, j) = powers(power.begin + packed_index(power.size, i, j));
      }
    }
    point.matrix_powers[power.term] = std::move(full);
  }
}

}  // namespace imunoise
