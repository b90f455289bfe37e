#include "study/analysis/series.h"

namespace imunoise::study {

Series series_of(std::span<const recording::Replicate> replicates, std::size_t channel) {
  Series out;
  out.channel = replicates.front().channels[channel].name;
  for (const recording::Replicate& replicate : replicates) {
    out.names.push_back(replicate.name);
    out.replicates.push_back(replicate.channels[channel].signal());
  }
  return out;
}

}  // namespace imunoise::study
