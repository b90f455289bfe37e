// Foreign families of the samples themselves, and one that is no defect.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "tests/hidden_effects/generator/apply.h"
#include "tests/hidden_effects/generator/draw.h"

namespace imunoise::hidden {
namespace {

void round_to(Series& values, double step) {
  for (double& x : values) x = step * std::round(x / step);
}

// A coarse converter never gives some of its codes: their samples get the next code. If both codes
// had as many, a sample that moved is worth 2·ln 2 nats to who knows the codes: δ² = 4·ln 2·count.
Injection hide_missing_codes(Scene& scene, double delta) {
  const double step = scene.floor() * log_uniform(scene.random, 0.1, 0.5);
  std::map<double, double> counts;
  for (Recording& recording : scene.recordings) {
    round_to(recording[kSubject], step);
    for (const double x : recording[kSubject]) ++counts[std::round(x / step)];
  }
  std::vector<std::pair<double, double>> codes(counts.begin(), counts.end());
  for (std::size_t i = codes.size(); i > 1; --i) {
    std::swap(codes[i - 1], codes[below(scene.random, i)]);
  }
  double moved = 0.0;
  const double wanted = delta * delta / (4.0 * std::numbers::ln2);
  std::map<double, bool> missing;
  for (const auto& [code, count] : codes) {
    if (moved + count > wanted || missing[code - 1.0] || missing[code + 1.0]) continue;
    missing[code] = true;
    moved += count;
  }
  for (Recording& recording : scene.recordings) {
    for (double& x : recording[kSubject]) {
      const double code = std::round(x / step);
      if (missing[code]) x = step * (code + 1.0);
    }
  }
  return {delta, delta, {{"step", step, "rad/s"}, {"count", moved, "1"}}};
}

// `delta` times a packet of 4 to 12 rows does not arrive, and the host repeats the row before.
Injection hide_held_packets(Scene& scene, double delta) {
  const auto count = static_cast<std::size_t>(std::lround(delta));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t rows = 4 + below(scene.random, 9);
    const std::size_t first = 1 + below(scene.random, scene.samples() - rows - 1);
    for (Trace& trace : scene.recordings[below(scene.random, scene.replicates())].traces) {
      std::fill_n(trace.values.begin() + static_cast<std::ptrdiff_t>(first), rows,
                  trace.values[first - 1]);
    }
  }
  return {delta, delta, {{"count", static_cast<double>(count), "1"}}};
}

// A text file with enough decimals: `delta` of all samples repeat the one before by chance, as
// neighbours of normal noise do with probability step/(2σ√π).
Injection hide_printed_decimals(Scene& scene, double delta) {
  const double n = static_cast<double>(scene.samples() * scene.replicates());
  const double step = 2.0 * std::sqrt(std::numbers::pi) * scene.floor() * delta / n;
  for (Recording& recording : scene.recordings) round_to(recording[kSubject], step);
  return {delta, delta, {{"step", step, "rad/s"}}};
}

}  // namespace

std::vector<HiddenEffect> foreign_samples() {
  HiddenEffect decimals = foreign("printed_decimals", "", hide_printed_decimals);
  decimals.kind = Kind::kHarmless;
  return {
      foreign("missing_codes", "", hide_missing_codes),
      foreign("duplicated_samples", "held_packets", hide_held_packets),
      decimals,
  };
}

}  // namespace imunoise::hidden
