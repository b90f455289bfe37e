#include "core/array/array_estimate.h"

#include "core/array/array_blocks.h"
#include "core/array/array_inference.h"
#include "core/array/array_start.h"
#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

constexpr int kReweightings = 2;

Segment segment_of(const ArrayModel& model, const Pair& pair, const Scales& scales) {
  Segment out{scales, {}};
  for (std::size_t t = 0; t < model.latents.size(); ++t) {
    const Latent& latent = model.latents[t];
    if (!latent.acts_on(pair.a) || !latent.acts_on(pair.b)) continue;
    out.shares.push_back(
        {t, latent.matrix() ? packed_index(model.sensors, pair.a, pair.b) : Eigen::Index{0}});
  }
  return out;
}

Model shapes_of(const ArrayModel& model) {
  Model out;
  for (const Latent& latent : model.latents) {
    out.terms.push_back(latent.term);
    if (!latent.term.given[0]) continue;
    std::vector<double> v = values(latent.term.process);
    v[0] = latent.scalar();
    set_values(out.terms.back().process, v);
  }
  return out;
}

Problem problem_of(const ArrayModel& model, const std::vector<ArrayBlock>& blocks,
                   const std::vector<Eigen::MatrixXd>& roots) {
  Problem out;
  out.model = shapes_of(model);
  for (std::size_t t = 0; t < model.latents.size(); ++t) {
    if (model.latents[t].matrix()) out.matrix_powers[t] = model.sensors;
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    MomentBlock block;
    for (const Pair& pair : blocks[b].pairs) {
      block.segments.push_back(segment_of(model, pair, blocks[b].group->scales));
    }
    block.measured = moments_of(blocks[b].group->mean, blocks[b].pairs);
    block.weight_root = roots[b];
    out.blocks.push_back(std::move(block));
  }
  return out;
}

ArrayModel model_of(const ArrayModel& open, const Minimum& found) {
  ArrayModel out = open;
  for (std::size_t t = 0; t < out.latents.size(); ++t) {
    Latent& latent = out.latents[t];
    std::vector<double> v = values(found.model.terms[t].process);
    if (latent.matrix()) {
      latent.power = found.matrix_powers.at(t);
    } else {
      latent.set_scalar(v[0]);
    }
    v[0] = 1.0;
    set_values(latent.term.process, v);
  }
  return out;
}

bool gives_weights(const ArrayModel& model, const std::vector<ReplicateGroup>& groups) {
  for (const ReplicateGroup& group : groups) {
    for (const Eigen::MatrixXd& at : covariance(model, group.scales)) {
      if (!(at.diagonal().array() > 0.0).all()) return false;
    }
  }
  return true;
}

}  // namespace

ArrayFit fit_array(const Model& written, const ArrayLayout& layout,
                   std::span<const WaveletCovariance> replicates, const ArrayOptions& options,
                   const Progress& progress) {
  const ArrayModel open = expand(written, layout);
  const std::vector<ReplicateGroup> groups = groups_of(replicates);
  ArrayFit fit;
  const Pairs pairs = options.cross ? all_pairs(open.sensors) : own_pairs(open.sensors);
  const std::vector<ArrayBlock> blocks = blocks_of(groups, pairs);
  fit.joint_weights = blocks.size() == groups.size();
  std::vector<Eigen::MatrixXd> roots;
  for (const ArrayBlock& block : blocks) roots.push_back(diagonal_root(block));

  std::vector<Model> starts;
  for (const ArrayModel& start : array_starts(written, open, replicates)) {
    starts.push_back(shapes_of(start));
  }
  Minimum found = minimise_from(problem_of(open, blocks, roots), starts, progress);
  for (int round = 0; round < kReweightings && options.weighting == Weighting::kFull; ++round) {
    const ArrayModel model = model_of(open, found);
    if (progress.stopped() || !gives_weights(model, groups)) break;
    const BlockCovariance covariance(model, blocks);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      roots[b] = whiten(covariance(model, blocks[b])).matrix;
    }
    // All starts compete once more under the first full weights; later rounds follow the best.
    if (round == 0) {
      starts.push_back(found.model);
    } else {
      starts = {found.model};
    }
    found = minimise_from(problem_of(open, blocks, roots), starts, progress);
  }
  fit.model = sorted(model_of(open, found));
  fit.objective = found.objective;
  fit.termination = found.termination;
  infer(fit, blocks, roots, options.confidence);
  return fit;
}

}  // namespace imunoise
