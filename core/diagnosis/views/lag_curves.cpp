#include "core/diagnosis/views/lag_curves.h"

#include <algorithm>
#include <cmath>

#include "core/search/evidence.h"
#include "core/search/lagged_witness.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

constexpr double kEachOctave = 2.0;
constexpr double kOnceInTwenty = 0.05;

}  // namespace

std::vector<LagCurve> lag_curves(const Current& current) {
  const Subject& subject = current.subject();
  const SlowView view(current);
  std::vector<LagCurve> out(subject.witnesses.size());
  for_each_index(out.size(), [&](std::size_t w) {
    const LaggedWitness witness(view, subject, subject.witnesses[w]);
    LagCurve& curve = out[w];
    curve.witness = subject.witnesses[w].name;
    if (!(witness.shortest() < witness.longest())) return;
    const auto steps =
        static_cast<int>(kEachOctave * std::log2(witness.longest() / witness.shortest()));
    Eigen::MatrixXd scores(view.whitened(witness.late(witness.shortest())).size(), 2 * steps + 2);
    Eigen::Index column = 0;
    for (int i = -steps - 1; i <= steps; ++i) {
      const int octaves = i < 0 ? -i - 1 : i;
      const double lag = witness.shortest() * std::exp2(static_cast<double>(octaves) / kEachOctave);
      scores.col(column) = view.whitened(i < 0 ? witness.early(lag) : witness.late(lag));
      curve.seconds.push_back(i < 0 ? -lag : lag);
      curve.nats.push_back(view.gain(scores.col(column), false));
      ++column;
    }
    curve.path = path_length(scores);
    curve.chance = gain_needed(kOnceInTwenty, 1.0, false, {curve.path, 0.0});
  });
  std::erase_if(out, [](const LagCurve& one) { return one.seconds.empty(); });
  return out;
}

}  // namespace imunoise
