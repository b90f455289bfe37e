#pragma once

// The three published virtual sensors (T = 1e7, 22 scales), and a study of the published structure
// of three gyros with four correlated AR1 each.

#include <cmath>
#include <string>
#include <vector>

#include "core/array/latents.h"

namespace imunoise::testing {

struct PublishedExample {
  std::string name;   ///< in the reference numbers
  std::string title;  ///< for people
  std::vector<double> white;
  Eigen::MatrixXd walk;
};

inline std::vector<PublishedExample> published_examples() {
  const Eigen::Vector2d two(2e-16, 2e-15);
  const Eigen::Vector3d three(2e-16, 2e-15, 2e-15);
  Eigen::MatrixXd correlated = three.asDiagonal();
  correlated(1, 2) = correlated(2, 1) = 0.9 * 2e-15;
  return {{"ex1_two", "two gyros", {2e-8, 2e-9}, two.asDiagonal()},
          {"ex2_three", "three gyros", {2e-8, 2e-9, 2e-8}, three.asDiagonal()},
          {"ex3_three_corr0.9", "the same, 2 and 3 correlate", {2e-8, 2e-9, 2e-8}, correlated}};
}

inline ArrayModel model_of(const PublishedExample& example) {
  const ArrayLayout layout{example.white.size(), {}};
  ArrayModel model = expand(parse_array_model("RW[corr] + WN", Hertz{1.0}).value(), layout);
  model.latents[0].power = example.walk;
  for (std::size_t i = 0; i < example.white.size(); ++i) {
    model.latents[1 + i].set_scalar(example.white[i]);
  }
  return model;
}

/// Three gyros at 100 Hz, each the sum of four AR1 of 0.02, 0.5, 20 and 400 s that correlate
/// between gyros. The structure is the published one; its numbers are not published with it: these
/// are ours. Gyro 1 is quiet at short times and gyro 3 at long ones, where 1 and 2 drift together.
inline ArrayModel four_markov_gyros() {
  ArrayModel model = expand(parse_array_model("4*AR1[corr]", Hertz{100.0}).value(), {3, {}});
  const std::vector<double> time = {0.02, 0.5, 20.0, 400.0};  // s
  Eigen::MatrixXd deviation(4, 3);                            // rad/s, stationary, a row a process
  deviation << 2e-3, 4e-3, 5e-3,                              //
      3e-4, 3e-4, 4e-4,                                       //
      2e-4, 1e-4, 1e-4,                                       //
      3e-4, 2e-4, 0.6e-4;
  Eigen::MatrixXd correlation(4, 3);  // of gyros 1-2, 1-3, 2-3
  correlation << 0.0, 0.1, 0.2,       //
      0.3, 0.0, 0.0,                  //
      0.2, -0.3, 0.1,                 //
      0.8, 0.1, 0.2;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const double phi = std::exp(-1.0 / (100.0 * time[k]));
    Eigen::Matrix3d c = Eigen::Matrix3d::Identity();
    c(0, 1) = c(1, 0) = correlation(row, 0);
    c(0, 2) = c(2, 0) = correlation(row, 1);
    c(1, 2) = c(2, 1) = correlation(row, 2);
    Latent& latent = model.latents[k];
    set_values(latent.term.process, std::vector<double>{1.0, phi});
    const Eigen::VectorXd s = std::sqrt(1.0 - phi * phi) * deviation.row(row).transpose();
    latent.power = s.asDiagonal() * c * s.asDiagonal();
  }
  return model;
}

}  // namespace imunoise::testing
