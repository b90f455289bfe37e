#include "study/figure/svg_style.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace imunoise::figure {
namespace {

constexpr double kSteps = 4.0;  // steps of a cell's colour on either side

}  // namespace

const char* role_name(Role role) {
  switch (role) {
    case Role::kMeasured:
      return "measured";
    case Role::kModel:
      return "model";
    case Role::kTerm:
      return "term";
    case Role::kGhost:
      return "ghost";
    case Role::kReplicate:
      return "replicate";
    case Role::kInterval:
      return "band";
    case Role::kChance:
      return "chance";
    case Role::kMisfit:
      return "misfit";
    case Role::kUntested:
      break;
  }
  return "untested";
}

std::string with_state(const char* css_class, State state) {
  return std::string(css_class) + (state == State::kOutside    ? " outside"
                                   : state == State::kUntested ? " untested"
                                                               : "");
}

std::string line_class(const Layer& layer) {
  if (layer.role == Role::kMeasured) return "trace";
  if (layer.role != Role::kTerm) return role_name(layer.role);
  return fmt::format("term term-{}", layer.style % kTermStyles);
}

const char* area_class(const Layer& layer) {
  return layer.role == Role::kMeasured ? "extent" : role_name(layer.role);
}

std::string data_attributes(const Datum& place) {
  std::string out;
  const auto add = [&](const char* name, double value) {
    if (std::isfinite(value))
      out += fmt::format("{}data-{}=\"{:.6g}\"", out.empty() ? "" : " ", name, value);
  };
  add("x", place.x);
  add("y", place.y);
  add("sigma", place.sigma);
  return out;
}

const char* bar_class(const Layer& layer) {
  return layer.role == Role::kMeasured ? "bar" : role_name(layer.role);
}

std::string cell_class(double sigma) {
  const int step = static_cast<int>(std::min(kSteps, kSteps * std::abs(sigma) / kFullColour + 0.5));
  return fmt::format("cell {}{}",
                     step == 0     ? "zero"
                     : sigma > 0.0 ? "plus"
                                   : "minus",
                     step == 0 ? "" : std::to_string(step));
}

}  // namespace imunoise::figure
