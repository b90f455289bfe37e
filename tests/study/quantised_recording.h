#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/model/model.h"
#include "study/ladder/study.h"

namespace imunoise::study {

/// Three replicates of white noise and a walk, with quantisation noise that the model lacks.
inline Result<std::vector<recording::Replicate>> read_quantised(const v1::StudyInput&,
                                                                const std::string&) {
  constexpr Hertz kRate{50.0};
  const Model noise = *parse_model("WN(sigma2=1) + RW(gamma2=1e-5) + QN(q2=0.3)", kRate);
  std::vector<recording::Replicate> out;
  for (std::uint32_t k = 0; k < 3; ++k) {
    auto samples = std::make_shared<recording::Samples>(simulate(noise, 4096, 21, k));
    recording::Channel channel{"gyro_x", samples, 0, 4096, 1.0, 0.0, *parse_unit("rad/s"), kRate};
    out.push_back({"run" + std::to_string(k + 1), "", kRate, {channel}});
  }
  return out;
}

}  // namespace imunoise::study
