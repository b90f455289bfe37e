#pragma once

#include <string>
#include <vector>

#include "imunoise/v1/diagnosis.pb.h"
#include "study/figure/figure.h"

namespace imunoise::report {

/// The measured wavelet variance against the model that was doubted.
figure::Figure before_figure(const v1::DiagnosisReport& report);

/// What the effects of the last rung leave of it, against the noise of that rung.
figure::Figure after_figure(const v1::DiagnosisReport& report);

/// A picture for papers, and the word that its file's name ends in.
struct Picture {
  std::string word;
  figure::Figure figure;
};

/// Noise budget and spectrum, before and after: "before", "after", "spectrum_before",
/// "spectrum_after". Where nothing was added there is no spectrum after. Then error_panel():
/// "errors".
std::vector<Picture> pictures(const v1::DiagnosisReport& report);

}  // namespace imunoise::report
