#pragma once

#include "core/estimate/parameter_scale.h"
#include "core/estimate/problem.h"

namespace imunoise {

/// The objective as a function of the free shape parameters only, in unbounded coordinates; powers
/// are solved inside (variable projection). Coordinates: logit between the bounds of the parameter,
/// or its logarithm.
class Profile {
 public:
  explicit Profile(const Problem& problem);

  /// A free shape parameter: which parameter of which term, with its bounds.
  struct Coordinate {
    std::size_t term;
    std::size_t parameter;
    ParameterInfo info;
    double to_search(double value) const;
    double to_value(double search) const;
    double slope(double value) const { return scale().slope(value); }  ///< d value / d search

   private:
    ParameterScale scale() const { return {info, parameter}; }
  };
  const std::vector<Coordinate>& coordinates() const { return coordinates_; }

  /// The model at a point, with its powers solved for.
  struct Point {
    Model model;
    std::map<std::size_t, Eigen::MatrixXd> matrix_powers;
    double objective;
  };
  /// Objective at the point, and its gradient where wanted (same length as x).
  Point at(const std::vector<double>& x, std::vector<double>* gradient = nullptr) const;

  /// The search coordinates of a model's shapes.
  std::vector<double> coordinates_of(const Model& model) const;

  /// Whitened column of what one entry of a term's power contributes over all blocks when it is 1:
  /// Σ r_b rows.
  Eigen::VectorXd column(Share share, const Process& process) const;
  /// Whitened measured moments, less what terms of given power explain.
  Eigen::VectorXd target(const Model& model) const;
  const Problem& problem() const { return problem_; }

 private:
  // A power that is solved for: a number, or the matrix of a term.
  struct FreePower {
    std::size_t term;
    Eigen::Index size;   // of the matrix; 1 for a number
    Eigen::Index begin;  // its first column
  };
  Eigen::VectorXd whitened(Share share, const std::vector<Eigen::ArrayXd>& per_grid) const;
  Eigen::VectorXd solve(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target) const;
  void set_powers(const Eigen::VectorXd& powers, Point& point) const;

  const Problem& problem_;
  std::vector<Coordinate> coordinates_;
  std::vector<FreePower> free_powers_;
  Eigen::Index free_columns_ = 0;
  Eigen::VectorXd measured_;  // whitened
  Eigen::Index rows_ = 0;
  std::vector<Eigen::ArrayXd> grids_;              // distinct half-widths
  std::vector<std::vector<std::size_t>> grid_of_;  // of each segment of each block
};

}  // namespace imunoise
