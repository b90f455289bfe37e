#include "core/search/wave_track.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/search/peak.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr Index kReach = 2;  // places from a piece's frequency to the next's

// The place near `at` where `score` is largest.
Index best_near(const Eigen::ArrayXd& score, Index at, const Band& in) {
  Index best = at;
  for (Index i = std::max(in.first, at - kReach); i <= std::min(in.last, at + kReach); ++i) {
    if (score(i) > score(best)) best = i;
  }
  return best;
}

// The most that a track may have gained up to piece `to` from piece `from`, by its place in `to`.
Eigen::ArrayXd gained(const WavePieces& pieces, Index from, Index to, const Band& in) {
  const Index step = from < to ? 1 : -1;
  Eigen::ArrayXd out = pieces.gain.col(from);
  for (Index p = from; p != to; p += step) {
    Eigen::ArrayXd next = pieces.gain.col(p + step);
    for (Index i = in.first; i <= in.last; ++i) next(i) += out(best_near(out, i, in));
    out = std::move(next);
  }
  return out;
}

// Phase and frequency in the middle of a piece, rad and rad per sample.
struct Node {
  double middle;
  double phase;
  double omega;
};

Node node_of(const Current& current, const WavePieces& pieces, Index p, Index place) {
  const double step = 1.0 / static_cast<double>(pieces.padded);
  const double near = pieces.frequency(place);
  const Stretch piece = pieces.piece(p);
  const double f = peak_between(near - step, near + step, 0.25 * step, [&](double at) {
                     return wave_gain(current, piece, at);
                   }).at;
  const double half = 0.5 * static_cast<double>(piece.length - 1);
  return {static_cast<double>(piece.begin) + half,
          std::arg(wave_sum(current, piece, f)) + kTurn * f * half, kTurn * f};
}

// The phase of a track at each sample.
Eigen::ArrayXd phase_along(const std::vector<Node>& nodes, Index n) {
  Eigen::ArrayXd out(n);
  std::size_t at = 0;
  double d = 0.0;
  double e = 0.0;
  const auto towards_next = [&] {
    const Node& from = nodes[at];
    const Node& to = nodes[at + 1];
    const double length = to.middle - from.middle;
    e = to.omega - from.omega;
    const double ahead = from.phase + from.omega * length + 0.5 * e * length - to.phase;
    d = to.phase + kTurn * std::round(ahead / kTurn) - from.phase - from.omega * length;
  };
  if (nodes.size() > 1) towards_next();
  double turns = 0.0;  // of the node's phase, which the cubics before it reached
  for (Index t = 0; t < n; ++t) {
    while (at + 1 < nodes.size() && static_cast<double>(t) >= nodes[at + 1].middle) {
      turns += nodes[at].phase + nodes[at].omega * (nodes[at + 1].middle - nodes[at].middle) + d -
               nodes[at + 1].phase;
      ++at;
      if (at + 1 < nodes.size()) towards_next();
    }
    const double after = static_cast<double>(t) - nodes[at].middle;
    out(t) = nodes[at].phase + turns + nodes[at].omega * after;
    if (after < 0.0 || at + 1 == nodes.size()) continue;  // straight before and behind the middles
    const double length = nodes[at + 1].middle - nodes[at].middle;
    const double share = after / length;
    out(t) += share * share * (3.0 * d - e * length + share * (e * length - 2.0 * d));
  }
  return out;
}

}  // namespace

Band WavePieces::band(double low, double high) const {
  const Index end = gain.rows() - 2;
  const auto lowest = static_cast<Index>(std::ceil(low * static_cast<double>(padded)));
  const auto highest = static_cast<Index>(std::floor(high * static_cast<double>(padded)));
  const Index begin = std::clamp<Index>(lowest, 1, end);
  return {begin, std::clamp<Index>(highest, begin, end)};
}

double WavePieces::log_tracks(const Band& in) const {
  return std::log(static_cast<double>(in.size())) +
         static_cast<double>(gain.cols() - 1) * std::log(2.0 * kReach + 1.0);
}

WavePieces wave_pieces(const Current& current, std::size_t replicate, Index count) {
  const Index length = current.subject().length(replicate) / count;
  const Index padded = padded_length(2 * length);
  WavePieces out{replicate, length, padded, Eigen::ArrayXXd(padded / 2 + 1, count)};
  for (Index p = 0; p < count; ++p)
    out.gain.col(p) = wave_gains(current, out.piece(p), padded).head(out.gain.rows());
  return out;
}

Eigen::ArrayXd gained_through_middle(const WavePieces& pieces) {
  const Band all{1, pieces.gain.rows() - 2};
  const Index middle = pieces.gain.cols() / 2;
  return gained(pieces, 0, middle, all) + gained(pieces, pieces.gain.cols() - 1, middle, all) -
         pieces.gain.col(middle);
}

WaveTrack best_track(const WavePieces& pieces, const Band& in) {
  const Index count = pieces.gain.cols();
  std::vector<Eigen::ArrayXd> up_to{pieces.gain.col(0)};
  for (Index p = 1; p < count; ++p) {
    Eigen::ArrayXd next = pieces.gain.col(p);
    for (Index i = in.first; i <= in.last; ++i)
      next(i) += up_to.back()(best_near(up_to.back(), i, in));
    up_to.push_back(std::move(next));
  }
  WaveTrack out(static_cast<std::size_t>(count));
  Index at = in.first;
  up_to.back().segment(in.first, in.last - in.first + 1).maxCoeff(&at);
  at += in.first;
  for (std::size_t p = out.size(); p-- > 0;) {
    out[p] = at;
    if (p > 0) at = best_near(up_to[p - 1], at, in);
  }
  return out;
}

double gain_of(const WavePieces& pieces, const WaveTrack& track) {
  double out = 0.0;
  for (std::size_t p = 0; p < track.size(); ++p)
    out += pieces.gain(track[p], static_cast<Index>(p));
  return out;
}

Eigen::ArrayXd phase_of(const Current& current, const WavePieces& pieces, const WaveTrack& track) {
  std::vector<Node> nodes;
  for (std::size_t p = 0; p < track.size(); ++p)
    nodes.push_back(node_of(current, pieces, static_cast<Index>(p), track[p]));
  return phase_along(nodes, current.subject().length(pieces.replicate));
}

}  // namespace imunoise
