#include "core/estimate/profile.h"

#include <algorithm>
#include <cmath>

#include "core/support/linear_algebra.h"

namespace imunoise {

double Profile::Coordinate::to_search(double value) const {
  return scale().to_scale(std::clamp(value, info.lower, info.upper));
}

double Profile::Coordinate::to_value(double search) const {
  return std::clamp(scale().to_value(search), info.lower, info.upper);
}

Profile::Profile(const Problem& problem) : problem_(problem) {
  for (std::size_t t = 0; t < problem.model.terms.size(); ++t) {
    const Term& term = problem.model.terms[t];
    const std::vector<ParameterInfo> about = parameters(term.process);
    if (!term.given[0]) free_powers_.push_back(t);
    for (std::size_t p = 1; p < about.size(); ++p) {
      if (!term.given[p]) coordinates_.push_back({t, p, about[p]});
    }
  }
  for (const MomentBlock& block : problem.blocks) {
    rows_ += block.weight_root.rows();
    const Eigen::ArrayXd grid = block.scales.half_widths();
    const auto found = std::find_if(grids_.begin(), grids_.end(), [&](const Eigen::ArrayXd& g) {
      return g.size() == grid.size() && (g == grid).all();
    });
    grid_of_block_.push_back(static_cast<std::size_t>(found - grids_.begin()));
    if (found == grids_.end()) grids_.push_back(grid);
  }
  measured_.resize(rows_);
  Eigen::Index row = 0;
  for (const MomentBlock& block : problem.blocks) {
    measured_.segment(row, block.weight_root.rows()) = block.weight_root * block.measured;
    row += block.weight_root.rows();
  }
}

Eigen::VectorXd Profile::whitened(std::size_t term,
                                  const std::vector<Eigen::ArrayXd>& per_grid) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(rows_);
  Eigen::Index row = 0;
  for (std::size_t b = 0; b < problem_.blocks.size(); ++b) {
    const MomentBlock& block = problem_.blocks[b];
    const Eigen::Index rows = block.weight_root.rows();
    if (std::find(block.terms.begin(), block.terms.end(), term) != block.terms.end()) {
      out.segment(row, rows) = block.weight_root * per_grid[grid_of_block_[b]].matrix();
    }
    row += rows;
  }
  return out;
}

Eigen::VectorXd Profile::column(std::size_t term, const Process& process) const {
  std::vector<Eigen::ArrayXd> shapes;
  for (const Eigen::ArrayXd& grid : grids_) shapes.push_back(shape(process, grid));
  return whitened(term, shapes);
}

Eigen::VectorXd Profile::target(const Model& model) const {
  Eigen::VectorXd out = measured_;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    const Term& term = model.terms[t];
    if (term.given[0]) out -= values(term.process)[0] * column(t, term.process);
  }
  return out;
}

std::vector<double> Profile::coordinates_of(const Model& model) const {
  std::vector<double> out;
  for (const Coordinate& c : coordinates_) {
    out.push_back(c.to_search(values(model.terms[c.term].process)[c.parameter]));
  }
  return out;
}

Profile::Point Profile::at(const std::vector<double>& x, std::vector<double>* gradient) const {
  Model model = problem_.model;
  std::vector<double> slopes(coordinates_.size());
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    const Coordinate& c = coordinates_[i];
    std::vector<double> v = values(model.terms[c.term].process);
    v[c.parameter] = c.to_value(x[i]);
    slopes[i] = c.slope(v[c.parameter]);
    set_values(model.terms[c.term].process, v);
  }

  Eigen::MatrixXd columns(rows_, static_cast<Eigen::Index>(free_powers_.size()));
  for (std::size_t i = 0; i < free_powers_.size(); ++i) {
    const std::size_t t = free_powers_[i];
    columns.col(static_cast<Eigen::Index>(i)) = column(t, model.terms[t].process);
  }
  const Eigen::VectorXd wanted = target(model);
  const Eigen::VectorXd powers = solve_powers(columns, wanted);
  const Eigen::VectorXd residual = wanted - columns * powers;
  for (std::size_t i = 0; i < free_powers_.size(); ++i) {
    Process& process = model.terms[free_powers_[i]].process;
    std::vector<double> v = values(process);
    v[0] = powers(static_cast<Eigen::Index>(i));
    set_values(process, v);
  }

  // By the envelope theorem only the direct dependence on the shapes counts: dQ/dη = -2 rᵀ W power
  // dshape.
  if (gradient != nullptr) {
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      const Coordinate& c = coordinates_[i];
      const Process& process = model.terms[c.term].process;
      const double power = values(process)[0];
      (*gradient)[i] = 0.0;
      if (power == 0.0) continue;
      std::vector<Eigen::ArrayXd> per_grid;
      for (const Eigen::ArrayXd& grid : grids_) {
        per_grid.emplace_back(
            shape_jacobian(process, grid).col(static_cast<Eigen::Index>(c.parameter - 1)));
      }
      (*gradient)[i] = -2.0 * power * slopes[i] * residual.dot(whitened(c.term, per_grid));
    }
  }
  return {std::move(model), residual.squaredNorm()};
}

Eigen::VectorXd solve_powers(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target) {
  const Eigen::VectorXd norms =
      columns.colwise().norm().transpose().unaryExpr([](double n) { return n > 0.0 ? n : 1.0; });
  const Eigen::MatrixXd scaled = columns * norms.cwiseInverse().asDiagonal();
  const Eigen::VectorXd powers =
      nonnegative_least_squares(scaled.transpose() * scaled, scaled.transpose() * target);
  return powers.cwiseQuotient(norms);
}

}  // namespace imunoise
