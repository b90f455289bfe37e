#pragma once

// Recordings between NumPy and the analyses.

#include <pybind11/numpy.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "recording/import/table/channel.h"

namespace imunoise::python {

/// Replicates of one import. Copies share the samples.
struct Recording {
  std::vector<recording::Replicate> replicates;  ///< never empty

  const recording::Channel& channel(std::size_t replicate, std::size_t number) const {
    return replicates.at(replicate).channels.at(number);
  }
};

using Samples = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;
/// A channel, and the samples of each replicate.
using NamedArrays = std::vector<std::pair<std::string, std::vector<Samples>>>;

/// Samples in SI, shape (count,), read only: those of the import itself where it stores doubles in
/// SI, else a copy.
pybind11::array_t<double> samples(const Recording& recording, std::size_t replicate,
                                  std::size_t channel);

/// A recording of arrays, which are copied once. `units` has one text a channel. Throws Failure: no
/// arrays, arrays of different lengths or more than one dimension, too few or no finite samples, an
/// unknown unit.
Recording from_arrays(const NamedArrays& arrays, const std::vector<std::string>& units,
                      double rate);

/// The replicates of a simulation, in SI.
Recording simulated(const std::string& model, double rate, std::size_t samples,
                    std::uint32_t replicates, std::uint64_t seed, const std::string& unit,
                    const std::string& channel, const pybind11::object& progress);

}  // namespace imunoise::python
