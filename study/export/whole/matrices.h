#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "study/export/consumer.h"

namespace imunoise::study {

/// A matrix of a filter and what it is called in files.
struct NamedMatrix {
  std::string_view name;  ///< "Phi", "Q", "H", "R", "P0"
  const Eigen::MatrixXd* matrix;
};
std::vector<NamedMatrix> matrices_of(const StateSpace& system);

/// A name that MATLAB, C++ and NumPy take: letters, digits and '_', a letter first.
std::string identifier(std::string_view name);
/// What the system stands for: its only output, or "array".
std::string system_name(const StateSpace& system);
/// Comment lines that say how to use the matrices.
std::vector<std::string> usage_words();
/// Numbers of a row, separated.
std::string row_text(const Eigen::MatrixXd& matrix, Eigen::Index row, std::string_view separator);

inline constexpr std::string_view kStatesHeld =
    "every noise process as states of a filter, for each axis, an array and its virtual sensor";

}  // namespace imunoise::study
