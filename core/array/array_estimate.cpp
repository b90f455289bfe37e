#include "core/array/array_estimate.h"

#include <algorithm>
#include <cmath>

#include "core/array/array_start.h"
#include "core/inference/intervals.h"
#include "core/support/distributions.h"
#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

constexpr Eigen::Index kMostJoint = 1200;
constexpr int kReweightings = 2;

// Replicates of one length and their average.
struct Group {
  Scales scales;
  std::size_t samples;
  double count;
  std::vector<Eigen::MatrixXd> mean;
};

std::vector<Group> groups_of(std::span<const WaveletCovariance> replicates) {
  std::vector<Group> out;
  for (const WaveletCovariance& one : replicates) {
    const auto found = std::find_if(out.begin(), out.end(), [&](const Group& group) {
      return group.samples == one.samples && group.scales == one.scales;
    });
    if (found == out.end()) {
      out.push_back({one.scales, one.samples, 1.0, one.covariance});
      continue;
    }
    found->count += 1.0;
    for (std::size_t j = 0; j < found->mean.size(); ++j) {
      found->mean[j] += (one.covariance[j] - found->mean[j]) / found->count;
    }
  }
  return out;
}

// The moments that are weighted together: one block of an estimation problem.
struct Block {
  const Group* group;
  Pairs pairs;
};

std::vector<Block> blocks_of(const std::vector<Group>& groups, const Pairs& pairs, bool& joint) {
  std::vector<Block> out;
  joint = true;
  for (const Group& group : groups) {
    if (static_cast<Eigen::Index>(group.scales.size() * pairs.size()) <= kMostJoint) {
      out.push_back({&group, pairs});
    } else {
      joint = false;
      for (const Pair& pair : pairs) out.push_back({&group, {pair}});
    }
  }
  return out;
}

// Ω = diag(1/Var) with the model-free variances of covariance_interval().
Eigen::MatrixXd diagonal_root(const Block& block) {
  const Eigen::ArrayXd degrees = equivalent_degrees(block.group->scales, block.group->samples);
  const auto n = degrees.size();
  Eigen::VectorXd out(n * static_cast<Eigen::Index>(block.pairs.size()));
  Eigen::Index at = 0;
  for (const auto& [a, b] : block.pairs) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::MatrixXd& c = block.group->mean[static_cast<std::size_t>(j)];
      const double variance = (c(a, a) * c(b, b) + c(a, b) * c(a, b)) / degrees(j);
      out(at++) = variance > 0.0 ? std::sqrt(block.group->count / variance) : 0.0;
    }
  }
  return out.asDiagonal();
}

Eigen::MatrixXd covariance_of(const ArrayModel& model, const Block& block) {
  return array_moment_covariance(model, block.pairs, block.group->scales, block.group->samples) /
         block.group->count;
}

Segment segment_of(const ArrayModel& model, const Pair& pair, const Scales& scales) {
  Segment out{scales, {}};
  for (std::size_t t = 0; t < model.latents.size(); ++t) {
    const Latent& latent = model.latents[t];
    const auto acts = [&](Eigen::Index sensor) {
      return std::find(latent.sensors.begin(), latent.sensors.end(), sensor) !=
             latent.sensors.end();
    };
    if (!acts(pair.a) || !acts(pair.b)) continue;
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

Problem problem_of(const ArrayModel& model, const std::vector<Block>& blocks,
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

bool gives_weights(const ArrayModel& model, const Scales& scales) {
  for (const Eigen::MatrixXd& at : covariance(model, scales)) {
    if (!(at.diagonal().array() > 0.0).all()) return false;
  }
  return true;
}

// Every free parameter of a model.
std::vector<ArrayParameter> parameters_of(const ArrayModel& model) {
  std::vector<ArrayParameter> out;
  for (std::size_t t = 0; t < model.latents.size(); ++t) {
    const Latent& latent = model.latents[t];
    const Eigen::Index first = latent.sensors.front();
    if (latent.matrix()) {
      for (const auto& [a, b] : all_pairs(model.sensors)) out.push_back({t, 0, a, b, {}});
    } else if (!latent.term.given[0]) {
      out.push_back({t, 0, first, first, {}});
    }
    for (std::size_t p = 1; p < latent.term.given.size(); ++p) {
      if (!latent.term.given[p]) out.push_back({t, p, first, first, {}});
    }
  }
  return out;
}

// d moments / d parameters, one column a parameter.
Eigen::MatrixXd jacobian(const ArrayModel& model, const std::vector<ArrayParameter>& parameters,
                         const Block& block) {
  const Eigen::ArrayXd m = block.group->scales.half_widths();
  const auto n = m.size();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n * static_cast<Eigen::Index>(block.pairs.size()),
                                              static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ArrayParameter& parameter = parameters[i];
    const Latent& latent = model.latents[parameter.latent];
    const Eigen::ArrayXd change =
        parameter.parameter == 0
            ? shape(latent.term.process, m)
            : Eigen::ArrayXd(shape_jacobian(latent.term.process, m)
                                 .col(static_cast<Eigen::Index>(parameter.parameter - 1)));
    for (std::size_t p = 0; p < block.pairs.size(); ++p) {
      const auto [a, b] = block.pairs[p];
      double factor = latent.power(a, b);
      if (parameter.parameter == 0 && latent.matrix()) {
        factor = a == parameter.row && b == parameter.column ? 1.0 : 0.0;
      } else if (parameter.parameter == 0) {
        const auto acts = [&](Eigen::Index s) {
          return std::find(latent.sensors.begin(), latent.sensors.end(), s) != latent.sensors.end();
        };
        factor = acts(a) && acts(b) ? 1.0 : 0.0;
      }
      out.col(static_cast<Eigen::Index>(i)).segment(static_cast<Eigen::Index>(p) * n, n) =
          factor * change.matrix();
    }
  }
  return out;
}

double value_of(const ArrayModel& model, const ArrayParameter& parameter) {
  const Latent& latent = model.latents[parameter.latent];
  if (parameter.parameter > 0) return values(latent.term.process)[parameter.parameter];
  return latent.power(parameter.row, parameter.column);
}

void fill_inference(ArrayFit& fit, const std::vector<Block>& blocks,
                    const std::vector<Eigen::MatrixXd>& roots, double confidence) {
  fit.parameters = parameters_of(fit.model);
  const auto p = static_cast<Eigen::Index>(fit.parameters.size());
  Eigen::MatrixXd bread = Eigen::MatrixXd::Zero(p, p);
  Eigen::MatrixXd meat = Eigen::MatrixXd::Zero(p, p);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Eigen::MatrixXd slope = roots[b] * jacobian(fit.model, fit.parameters, blocks[b]);
    const Eigen::MatrixXd spread =
        roots[b] * covariance_of(fit.model, blocks[b]) * roots[b].transpose();
    bread += slope.transpose() * slope;
    meat += slope.transpose() * spread * slope;
  }
  const PseudoInverse inverse = pseudo_inverse(bread);
  fit.covariance = inverse.matrix * meat * inverse.matrix;
  const double z = normal_quantile(0.5 + 0.5 * confidence);
  for (Eigen::Index i = 0; i < p; ++i) {
    ArrayParameter& parameter = fit.parameters[static_cast<std::size_t>(i)];
    const Latent& latent = fit.model.latents[parameter.latent];
    const double value = value_of(fit.model, parameter);
    const double error = inverse.null_share(i) > 0.2
                             ? std::numeric_limits<double>::infinity()
                             : std::sqrt(std::max(fit.covariance(i, i), 0.0));
    if (parameter.row != parameter.column) {  // a covariance has no sign to respect
      parameter.estimate = {
          value, error, value - z * error, value + z * error,
          std::isfinite(error) ? Observability::kObserved : Observability::kIndistinguishable};
    } else {
      parameter.estimate = interval(imunoise::parameters(latent.term.process)[parameter.parameter],
                                    parameter.parameter, value, error, confidence);
    }
  }
}

}  // namespace

ArrayFit fit_array(const Model& written, const ArrayLayout& layout,
                   std::span<const WaveletCovariance> replicates, const ArrayOptions& options,
                   const Progress& progress) {
  const ArrayModel open = expand(written, layout);
  const std::vector<Group> groups = groups_of(replicates);
  ArrayFit fit;
  const std::vector<Block> blocks = blocks_of(
      groups, options.cross ? all_pairs(open.sensors) : own_pairs(open.sensors), fit.joint_weights);
  std::vector<Eigen::MatrixXd> roots;
  for (const Block& block : blocks) roots.push_back(diagonal_root(block));

  std::vector<Model> starts;
  for (const ArrayModel& start : array_starts(written, open, replicates)) {
    starts.push_back(shapes_of(start));
  }
  Minimum found = minimise_from(problem_of(open, blocks, roots), starts, progress);
  for (int round = 0; round < kReweightings && options.weighting == Weighting::kFull; ++round) {
    const ArrayModel model = model_of(open, found);
    if (progress.stopped() || !gives_weights(model, groups.front().scales)) break;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      roots[b] = whiten(covariance_of(model, blocks[b])).matrix;
    }
    // All starts compete once more under the first full weights; later rounds follow the best.
    if (round == 0) {
      starts.push_back(found.model);
    } else {
      starts = {found.model};
    }
    found = minimise_from(problem_of(open, blocks, roots), starts, progress);
  }
  fit.model = model_of(open, found);
  fit.objective = found.objective;
  fit.termination = found.termination;
  fit.model = sorted(std::move(fit.model));
  fill_inference(fit, blocks, roots, options.confidence);
  return fit;
}

}  // namespace imunoise
