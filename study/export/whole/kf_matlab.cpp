#include <fmt/format.h>

#include "study/export/whole/matrices.h"

namespace imunoise::study::consumers {
namespace {

std::string cell(const std::vector<std::string>& texts) {
  std::string out = "{";
  for (const std::string& one : texts) out += (out.size() > 1 ? ", '" : "'") + one + "'";
  return out + "}";
}

std::string kf_matlab_file(const Sheet& sheet) {
  std::string out = commented(sheet, "%");
  for (const StateSpace& one : sheet.systems) {
    const std::string name = identifier(system_name(one));
    out += fmt::format("{0}.dt = {1:.17g};\n{0}.outputs = {2};\n{0}.states = {3};\n", name, one.dt,
                       cell(one.outputs), cell(one.states));
    for (const NamedMatrix& matrix : matrices_of(one)) {
      out += fmt::format("{}.{} = [", name, matrix.name);
      for (Eigen::Index i = 0; i < matrix.matrix->rows(); ++i)
        out += (i == 0 ? "" : "; ") + row_text(*matrix.matrix, i, " ");
      out += "];\n";
    }
  }
  return out;
}

}  // namespace

const Consumer& kf_matlab() {
  static const Consumer kConsumer{
      .name = "kf-matlab",
      .title = "MATLAB (Kalman filter)",
      .file = "kf.m",
      .holds = kStatesHeld,
      .holding = Holding::kStates,
      .axes = AxisRule::kEach,
      .write = kf_matlab_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
