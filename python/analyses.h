#pragma once

// Each analysis returns the JSON that the command of its name prints for one channel.

#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/recording.h"

namespace imunoise::python {

/// How wavelet variances are measured; as the options of `imunoise wv`.
struct Measuring {
  int per_octave = 1;
  std::optional<double> robust;  ///< 0.6, 0.8 or 0.9; unset: classical
  double confidence = 0.95;
};

using Text = std::optional<std::string>;
using Words = std::vector<std::string>;

std::string wavelet_variance(const Recording& recording, std::size_t channel,
                             const Measuring& measuring, const pybind11::object& progress);

/// As `imunoise wv --allan --json`; `kind`: "allan" or "hadamard".
std::string deviation(const Recording& recording, std::size_t channel, const std::string& kind,
                      double confidence);

std::string fit(const Recording& recording, std::size_t channel, const Text& model,
                const std::string& estimator, const std::string& weights,
                const Measuring& measuring, const pybind11::object& progress);

std::string diagnose(const Recording& recording, std::size_t channel, const Text& model,
                     const Words& witnesses, bool automatic, double level,
                     const pybind11::object& progress);

/// `rule`: "unit-gain", "nonnegative" or "unit-length".
std::string array(const Recording& recording, const std::vector<std::size_t>& channels,
                  const Text& model, const std::vector<Words>& groups, const std::string& scales,
                  const std::string& rule, bool efficient, double confidence,
                  const pybind11::object& progress);

/// One operation on a study's JSON; both texts are messages of study.proto. `study` is empty for an
/// Open.
std::string study(const Recording& recording, const std::string& study, const std::string& request,
                  const pybind11::object& progress);

/// The bytes of the file for another program, of fits as `imunoise fit --json` prints them, or of
/// an array. `axis`: "each", "worst", "mean" or none; `horizon` in s.
std::string export_noise(const std::string& fits, const std::string& to, const Text& axis,
                         bool conservative, std::pair<double, double> horizon,
                         std::optional<double> step, const std::string& source);

}  // namespace imunoise::python
