#include "study/words/verdict.h"

#include <cmath>

namespace imunoise::report {
namespace {

constexpr double kFitsFrom = 0.05;
constexpr double kDoubtfulFrom = 0.01;

}  // namespace

Verdict verdict_at(double p_value) {
  if (!std::isfinite(p_value)) return Verdict::kUntested;
  return p_value >= kFitsFrom       ? Verdict::kFits
         : p_value >= kDoubtfulFrom ? Verdict::kDoubtful
                                    : Verdict::kFails;
}

bool fails(Verdict verdict) { return verdict == Verdict::kFails || verdict == Verdict::kDoubtful; }

std::string_view verdict_words(Verdict verdict) {
  switch (verdict) {
    case Verdict::kFits:
      return "fits";
    case Verdict::kDoubtful:
      return "doubtful";
    case Verdict::kFails:
      return "does not fit";
    case Verdict::kUntested:
      break;
  }
  return "not tested";
}

}  // namespace imunoise::report
