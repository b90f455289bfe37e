#include "core/effects/distributions/power_spell.h"

#include <algorithm>
#include <cmath>

#include "core/regression/modulation.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// Blocks of samples, whose ends are the places that a first look tries.
constexpr Index kMostBlocks = 256;
constexpr Index kSmallestBlock = 32;  // samples
// Shorter is a burst; longer, the replicate is another one.
constexpr Index kShortest = 16;     // an n-th of the series
constexpr double kLongest = 0.875;  // of it

// Sums of squares: of all, and of those within.
PowerSpell of_sums(Index begin, Index end, double within, double all, Index samples) {
  const auto inside = static_cast<double>(end - begin);
  const double outside = static_cast<double>(samples) - inside;
  const double in = within / inside;
  const double out = (all - within) / outside;
  if (!(in > 0.0 && out > 0.0)) return {begin, end};
  const double one = all / static_cast<double>(samples);
  return {begin, end, -0.5 * (inside * std::log(in / one) + outside * std::log(out / one)),
          in / out, std::sqrt(2.0 / inside + 2.0 / outside)};
}

// Sums of the squares before each sample, and of all.
Eigen::VectorXd sums_of_squares(const Eigen::VectorXd& white) {
  Eigen::VectorXd out(white.size() + 1);
  out(0) = 0.0;
  for (Index t = 0; t < white.size(); ++t) out(t + 1) = out(t) + white(t) * white(t);
  return out;
}

// The best of the parts that it looks at.
class Best {
 public:
  explicit Best(const Eigen::VectorXd& white) : sum_(sums_of_squares(white)) {}
  void look(Index begin, Index end) {
    const Index samples = sum_.size() - 1;
    const PowerSpell one = of_sums(begin, end, sum_(end) - sum_(begin), sum_(samples), samples);
    if (one.nats > found_.nats) found_ = one;
  }
  const PowerSpell& found() const { return found_; }

 private:
  Eigen::VectorXd sum_;
  PowerSpell found_;
};

}  // namespace

PowerSpell power_spell(const Eigen::VectorXd& white, Index begin, Index end) {
  return of_sums(begin, end, white.segment(begin, end - begin).squaredNorm(), white.squaredNorm(),
                 white.size());
}

PowerSpell best_spell(const Eigen::VectorXd& white) {
  const Index samples = white.size();
  const Index blocks = std::min(kMostBlocks, samples / kSmallestBlock);
  if (blocks < kShortest) return {};
  Best best(white);
  const auto edge = [&](Index block) { return block * samples / blocks; };
  const Index shortest = blocks / kShortest;
  const auto longest = static_cast<Index>(kLongest * static_cast<double>(blocks));
  for (Index b = 0; b < blocks; ++b) {
    for (Index e = b + shortest; e <= std::min(blocks, b + longest); ++e)
      best.look(edge(b), edge(e));
  }
  // To the sample, an end after the other.
  const Index reach = samples / blocks;
  for (const bool begins : {true, false, true, false}) {
    const PowerSpell near = best.found();
    if (begins ? near.begin == 0 : near.end == samples) continue;
    for (Index move = -reach; move <= reach; ++move) {
      const Index b = std::max<Index>(0, near.begin + (begins ? move : 0));
      const Index e = std::min(samples, near.end + (begins ? 0 : move));
      if (e - b >= reach) best.look(b, e);
    }
  }
  return best.found();
}

PowerSpell best_beside(const Eigen::VectorXd& white, const PowerSpell& spell) {
  const Index samples = white.size();
  const Index shortest = samples / kShortest;
  Best best(white);
  for (Index e = spell.end + shortest; e <= samples; ++e) best.look(spell.end, e);
  for (Index b = spell.begin - shortest; b >= 0; --b) best.look(b, spell.begin);
  return best.found();
}

PowerSpell without_gap(const Eigen::VectorXd& white, const PowerSpell& spell) {
  const PowerSpell gap = best_spell(white.segment(spell.begin, spell.size()));
  constexpr double kSurely = 5.0;  // nats
  if (!(gap.nats > std::log(kSpells) + kSurely)) return spell;
  // Its power is that outside, and not that of the rest of the spell.
  const auto mean = [&](Index begin, Index samples) {
    return white.segment(begin, samples).squaredNorm() / static_cast<double>(samples);
  };
  const double outside = mean(spell.begin, spell.size()) / spell.ratio;
  const double between = mean(spell.begin + gap.begin, gap.size());
  if (std::abs(std::log(gap.ratio)) < std::abs(std::log(between / outside))) return spell;
  const PowerSpell first = power_spell(white, spell.begin, spell.begin + gap.begin);
  const PowerSpell second = power_spell(white, spell.begin + gap.end, spell.end);
  return first.nats > second.nats ? first : second;
}

double excess_scatter(const Eigen::VectorXd& white, const PowerSpell& spell) {
  Eigen::ArrayXd squares = white.array().square();
  squares.segment(spell.begin, spell.size()) /= spell.ratio;
  const double mean = squares.mean();
  return std::max(1.0, 0.5 * (squares.square().mean() / (mean * mean) - 1.0));
}

std::vector<Eigen::VectorXd> beside_spells(std::vector<Eigen::VectorXd> white) {
  constexpr double kSurely = 20.0;  // nats
  for (Eigen::VectorXd& one : white) {
    const PowerSpell spell = best_spell(one);
    if (spell.nats > kSurely * excess_scatter(one, spell))
      one.segment(spell.begin, spell.size()) /= std::sqrt(spell.ratio);
  }
  return white;
}

Eigen::VectorXd course_of(const PowerSpell& spell, Index samples, double width) {
  const auto risen = [&](double from_edge) {
    return std::clamp(0.5 + from_edge / std::max(1.0, width), 0.0, 1.0);
  };
  Eigen::VectorXd out(samples);
  for (Index t = 0; t < samples; ++t) {
    const double place = static_cast<double>(t) + 0.5;
    const double in = spell.begin == 0 ? 1.0 : risen(place - static_cast<double>(spell.begin));
    const double until = spell.end == samples ? 1.0 : risen(static_cast<double>(spell.end) - place);
    out(t) = std::min(in, until);
  }
  return out;
}

double sharpness(const Eigen::VectorXd& white, const PowerSpell& spell) {
  const Innovations one{{0}, {white}};
  const auto gain = [&](double width) {
    return modulation_by({{SharedVector(course_of(spell, white.size(), width))}}, one)
        .log_likelihood;
  };
  return gain(0.0) - gain(0.25 * static_cast<double>(spell.size()));
}

}  // namespace imunoise
