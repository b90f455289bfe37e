#include <fmt/format.h>

#include "core/support/json_text.h"
#include "study/export/whole/matrices.h"

namespace imunoise::study::consumers {
namespace {

std::string json_list(const std::vector<std::string>& texts) {
  std::vector<std::string> out;
  for (const std::string& one : texts) out.push_back(json_string(one));
  return json_array(out);
}

std::string kf_json_file(const Sheet& sheet) {
  std::string out = "{\n" + json_comment(sheet, "  ") + "  \"systems\": [";
  const char* separator = "\n";
  for (const StateSpace& one : sheet.systems) {
    out += fmt::format("{}    {{\n      \"name\": {},\n      \"dt\": {:.17g},\n", separator,
                       json_string(system_name(one)), one.dt);
    out += fmt::format("      \"outputs\": {},\n      \"states\": {}", json_list(one.outputs),
                       json_list(one.states));
    for (const NamedMatrix& matrix : matrices_of(one)) {
      std::vector<std::string> rows;
      for (Eigen::Index i = 0; i < matrix.matrix->rows(); ++i)
        rows.push_back("[" + row_text(*matrix.matrix, i, ", ") + "]");
      out += fmt::format(",\n      \"{}\": {}", matrix.name, json_array(rows));
    }
    out += "\n    }";
    separator = ",\n";
  }
  return out + "\n  ]\n}\n";
}

}  // namespace

const Consumer& kf_json() {
  static const Consumer kConsumer{
      .name = "kf-json",
      .title = "JSON (Kalman filter)",
      .file = "kf.json",
      .holds = kStatesHeld,
      .holding = Holding::kStates,
      .axes = AxisRule::kEach,
      .write = kf_json_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
