#include "study/export/whole/matrices.h"

#include <fmt/format.h>

#include <cctype>

namespace imunoise::study {

std::vector<NamedMatrix> matrices_of(const StateSpace& system) {
  return {{"Phi", &system.phi},
          {"Q", &system.q},
          {"H", &system.h},
          {"R", &system.r},
          {"P0", &system.p0}};
}

std::string identifier(std::string_view name) {
  std::string out;
  for (const char c : name) out += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (out.empty() || std::isalpha(static_cast<unsigned char>(out.front())) == 0) out = "x" + out;
  return out;
}

std::string system_name(const StateSpace& system) {
  return system.outputs.size() == 1 ? system.outputs.front() : "array";
}

std::vector<std::string> usage_words() {
  return {
      "x(k+1) = Phi x(k) + w, var w = Q; noise of the output: y(k) = H x(k) + v, var v = R; SI.",
      "One step is one sample. P0 is the covariance of x at the start: add the variance of the "
      "power-on bias to its states named bias."};
}

std::string row_text(const Eigen::MatrixXd& matrix, Eigen::Index row, std::string_view separator) {
  std::string out;
  for (Eigen::Index k = 0; k < matrix.cols(); ++k)
    out += fmt::format("{}{:.17g}", k == 0 ? "" : separator, matrix(row, k));
  return out;
}

}  // namespace imunoise::study
