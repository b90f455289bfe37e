#pragma once

// The views of a study: one of its models beside the data.

#include <optional>
#include <string>
#include <vector>

#include "imunoise/v1/study.pb.h"
#include "study/figure/figure.h"

namespace imunoise::report {

/// Names of the views: averaging_times, spectrum, time, distribution, witnesses, replicates.
const std::vector<std::string>& study_views();

struct StudyFigureOptions {
  std::string view{};                        ///< one of study_views()
  std::uint32_t attempt = 0;                 ///< an attempt of the study that has a picture
  const v1::RungPicture* preview = nullptr;  ///< of a model that might be: drawn as a ghost
  bool variance = false;                     ///< wavelet variance instead of Allan deviation
  bool si = false;                           ///< Allan deviation in SI, not in data sheets' units
};

/// Nothing where the data show nothing in this view: one replicate, no witnesses, too few samples.
std::optional<figure::Figure> study_figure(const v1::Study& study,
                                           const StudyFigureOptions& options);

}  // namespace imunoise::report
