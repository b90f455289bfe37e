#include "study/report/view/bias_instability.h"

#include "study/report/view/coefficient_words.h"

namespace imunoise::report {
namespace {

BiasInstability in_words(const v1::BiasInstability& one, Digits digits) {
  BiasInstability out{"", one.has_value() ? value_words(one.value(), digits) : "none", ""};
  if (one.kind() == "flicker") {
    out.meaning = "coefficient of flicker noise";
    out.remark = one.has_value() ? "of the model" : "the model has no FN";
  } else if (one.kind() == "minimum") {
    out.meaning = "minimum of the Allan deviation / 0.664";
    out.remark =
        one.has_value() ? "measured at " + duration(one.time().value()) : "nothing was measured";
    if (one.at_edge()) out.remark += ", at the edge: record longer";
  } else {
    out.meaning = "standard deviation of the slowest Markov process";
    out.remark = one.has_value() ? "correlation time " + value_words(one.time(), digits)
                                 : "the model has no AR1 or GM";
  }
  return out;
}

}  // namespace

std::vector<BiasInstability> bias_instabilities(const v1::FitReport& report, Digits digits) {
  std::vector<BiasInstability> out;
  for (const v1::BiasInstability& one : report.bias_instability())
    out.push_back(in_words(one, digits));
  return out;
}

}  // namespace imunoise::report
