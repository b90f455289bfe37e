#pragma once

#include <vector>

#include "core/regression/current.h"

namespace imunoise {

/// Two channels that move together, at the frequencies where they do most.
struct SensorPair {
  std::size_t first = 0;  ///< 0: the channel under study, less its effects; else witness + 1
  std::size_t second = 0;
  double from = 0.0;         ///< Hz
  double to = 0.0;           ///< Hz
  double correlation = 0.0;  ///< in step there, all replicates together
  double sigma = 0.0;        ///< normal score of that (Fisher's z)
  double p_value = 1.0;      ///< that any half octave of any pair looks so much alike by chance
  std::size_t places = 0;    ///< half octaves that were looked at
};

/// What every two channels share that the model does not explain, a pair each. Correlation is
/// sought in half octaves, each channel against its own power there; neighbours that agree are one
/// stretch.
std::vector<SensorPair> sensor_pairs(const Current& current);

/// The pairs of the channel under study with each witness.
std::vector<SensorPair> witness_pairs(const Current& current);

}  // namespace imunoise
