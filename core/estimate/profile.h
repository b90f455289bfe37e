#pragma once

#include "core/estimate/problem.h"
#include "core/process/parameter_scale.h"

namespace imunoise {

/// The objective as a function of the free shape parameters and of the slopes of trends, in
/// unbounded coordinates; powers are solved inside (variable projection), and so are both ends of a
/// power that is linear in the covariate.
class Profile {
 public:
  explicit Profile(const Problem& problem);

  /// A free shape parameter, on the scale that suits it: which parameter of which term, with its
  /// bounds. Or the slope of a parameter's trend, on the scale of its link.
  struct Coordinate {
    std::size_t term;
    std::size_t parameter;
    ParameterInfo info;
    bool slope = false;
    double to_search(double value) const;
    double to_value(double search) const;
    double lower() const;  ///< of the search
    double upper() const;
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

  /// The search coordinates of a model's shapes and slopes.
  std::vector<double> coordinates_of(const Model& model) const;

  /// Whitened column of what one entry of a term's power contributes over all blocks when it is 1
  /// and follows no covariate: Σ r_b rows.
  Eigen::VectorXd column(Share share, const Process& process) const;
  /// Whitened measured moments, less what terms of given power explain.
  Eigen::VectorXd target(const Model& model) const;
  const Problem& problem() const { return problem_; }

 private:
  // A power that is solved for: a number, the two ends of a number that is linear in the covariate,
  // or the matrix of a term.
  struct FreePower {
    std::size_t term;
    Eigen::Index size;   // of the matrix; 1 for a number
    Eigen::Index begin;  // its first column
    Eigen::Index columns;
  };
  // Where moments are expected: half-widths, and the covariate there.
  struct Site {
    Eigen::ArrayXd half_widths;
    double covariate;
    bool operator==(const Site& other) const {
      return covariate == other.covariate && half_widths.size() == other.half_widths.size() &&
             (half_widths == other.half_widths).all();
    }
  };
  Model model_of(const std::vector<double>& x) const;
  Eigen::VectorXd whitened(Share share, const std::vector<Eigen::ArrayXd>& per_site) const;
  Eigen::VectorXd column(const FreePower& power, Eigen::Index index, const Term& term) const;
  double derivative(const Coordinate& coordinate, const Term& term, const Eigen::VectorXd& powers,
                    const Eigen::VectorXd& residual) const;
  Eigen::VectorXd solve(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target) const;
  void set_powers(const Eigen::VectorXd& powers, Point& point) const;

  const Problem& problem_;
  std::vector<Coordinate> coordinates_;
  std::vector<FreePower> free_powers_;
  Eigen::Index free_columns_ = 0;
  Eigen::VectorXd measured_;  // whitened
  Eigen::Index rows_ = 0;
  std::vector<Site> sites_;                        // distinct
  std::vector<std::vector<std::size_t>> site_of_;  // of each segment of each block
};

}  // namespace imunoise
