#include <fmt/format.h>

#include "study/export/whole/matrices.h"

namespace imunoise::study::consumers {
namespace {

std::string texts(std::string_view name, const std::vector<std::string>& values) {
  std::string out =
      fmt::format("inline constexpr std::array<const char*, {}> {} = {{", values.size(), name);
  for (std::size_t i = 0; i < values.size(); ++i)
    out += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", values[i]);
  return out + "};\n";
}

// Row-major, so that Eigen::Map<const Matrix<double, R, C, RowMajor>>(Phi.data()) reads it.
std::string kf_cpp_file(const Sheet& sheet) {
  std::string out =
      commented(sheet, "//") + "// Matrices are row-major.\n#pragma once\n\n#include <array>\n";
  for (const StateSpace& one : sheet.systems) {
    out += fmt::format("\nnamespace imu_noise::{} {{\n", identifier(system_name(one)));
    out += fmt::format("inline constexpr double dt = {:.17g};  // s\n", one.dt);
    out += texts("outputs", one.outputs) + texts("states", one.states);
    for (const NamedMatrix& matrix : matrices_of(one)) {
      out += fmt::format("inline constexpr std::array<double, {}> {} = {{", matrix.matrix->size(),
                         matrix.name);
      for (Eigen::Index i = 0; i < matrix.matrix->rows() && matrix.matrix->cols() > 0; ++i)
        out += (i == 0 ? "" : ", ") + row_text(*matrix.matrix, i, ", ");
      out += fmt::format("}};  // {} x {}\n", matrix.matrix->rows(), matrix.matrix->cols());
    }
    out += "}\n";
  }
  return out;
}

}  // namespace

const Consumer& kf_cpp() {
  static const Consumer kConsumer{
      .name = "kf-cpp",
      .title = "C++ header (Kalman filter)",
      .file = "kf.h",
      .holds = kStatesHeld,
      .holding = Holding::kStates,
      .axes = AxisRule::kEach,
      .write = kf_cpp_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
