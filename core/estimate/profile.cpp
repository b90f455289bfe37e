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
    if (!term.given[0]) {
      const auto matrix = problem.matrix_powers.find(t);
      const Eigen::Index size = matrix == problem.matrix_powers.end() ? 1 : matrix->second;
      free_powers_.push_back({t, size, free_columns_});
      free_columns_ += packed_size(size);
    }
    for (std::size_t p = 1; p < about.size(); ++p) {
      if (!term.given[p]) coordinates_.push_back({t, p, about[p]});
    }
  }
  for (const MomentBlock& block : problem.blocks) {
    rows_ += block.weight_root.rows();
    std::vector<std::size_t> grid_of;
    for (const Segment& segment : block.segments) {
      const Eigen::ArrayXd grid = segment.scales.half_widths();
      const auto found = std::find_if(grids_.begin(), grids_.end(), [&](const Eigen::ArrayXd& g) {
        return g.size() == grid.size() && (g == grid).all();
      });
      grid_of.push_back(static_cast<std::size_t>(found - grids_.begin()));
      if (found == grids_.end()) grids_.push_back(grid);
    }
    grid_of_.push_back(std::move(grid_of));
  }
  measured_.resize(rows_);
  Eigen::Index row = 0;
  for (const MomentBlock& block : problem.blocks) {
    measured_.segment(row, block.weight_root.rows()) = block.weight_root * block.measured;
    row += block.weight_root.rows();
  }
}

Eigen::VectorXd Profile::whitened(Share share, const std::vector<Eigen::ArrayXd>& per_grid) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(rows_);
  Eigen::Index row = 0;
  for (std::size_t b = 0; b < problem_.blocks.size(); ++b) {
    const MomentBlock& block = problem_.blocks[b];
    const Eigen::Index rows = block.weight_root.rows();
    Eigen::Index moment = 0;
    for (std::size_t s = 0; s < block.segments.size(); ++s) {
      const Segment& segment = block.segments[s];
      const Eigen::ArrayXd& values = per_grid[grid_of_[b][s]];
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
  for (const Eigen::ArrayXd& grid : grids_) shapes.push_back(shape(process, grid));
  return whitened(share, shapes);
}

Eigen::VectorXd Profile::target(const Model& model) const {
  Eigen::VectorXd out = measured_;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    const Term& term = model.terms[t];
    if (term.given[0]) out -= values(term.process)[0] * column({t, 0}, term.process);
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

  Eigen::MatrixXd columns(rows_, free_columns_);
  for (const FreePower& power : free_powers_) {
    for (Eigen::Index e = 0; e < packed_size(power.size); ++e) {
      columns.col(power.begin + e) = column({power.term, e}, model.terms[power.term].process);
    }
  }
  const Eigen::VectorXd wanted = target(model);
  const Eigen::VectorXd powers = solve(columns, wanted);
  const Eigen::VectorXd residual = wanted - columns * powers;
  Point point{std::move(model), {}, residual.squaredNorm()};
  set_powers(powers, point);

  // By the envelope theorem only the direct dependence on the shapes counts:
  // dQ/dη = -2 rᵀ W Σ power dshape.
  if (gradient != nullptr) {
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      const Coordinate& c = coordinates_[i];
      const Process& process = point.model.terms[c.term].process;
      std::vector<Eigen::ArrayXd> per_grid;
      for (const Eigen::ArrayXd& grid : grids_) {
        per_grid.emplace_back(
            shape_jacobian(process, grid).col(static_cast<Eigen::Index>(c.parameter - 1)));
      }
      double sum = 0.0;
      const auto add = [&](Eigen::Index entry, double power) {
        if (power != 0.0) sum += power * residual.dot(whitened({c.term, entry}, per_grid));
      };
      const auto found = std::find_if(free_powers_.begin(), free_powers_.end(),
                                      [&](const FreePower& p) { return p.term == c.term; });
      if (found == free_powers_.end()) {
        add(0, values(process)[0]);
      } else {
        for (Eigen::Index e = 0; e < packed_size(found->size); ++e) {
          add(e, powers(found->begin + e));
        }
      }
      (*gradient)[i] = -2.0 * slopes[i] * sum;
    }
  }
  return point;
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
    Process& process = point.model.terms[power.term].process;
    std::vector<double> v = values(process);
    const bool matrix = problem_.matrix_powers.contains(power.term);
    v[0] = matrix ? 1.0 : powers(power.begin);
    set_values(process, v);
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
