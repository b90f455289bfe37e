#include "study/export/whole/state_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/export/whole/unit_block.h"

namespace imunoise::study {
namespace {

using Index = Eigen::Index;

void grow(Eigen::MatrixXd& matrix, Index rows, Index columns) {
  matrix.conservativeResizeLike(
      Eigen::MatrixXd::Zero(matrix.rows() + rows, matrix.cols() + columns));
}

// Puts a system together, latent by latent.
class Assembly {
 public:
  Assembly(const std::vector<std::string>& outputs, double dt)
      : bias_(outputs.size(), -1), slope_(outputs.size(), -1) {
    const auto n = static_cast<Index>(outputs.size());
    system_.dt = dt;
    system_.outputs = outputs;
    system_.h.resize(n, 0);
    system_.r = Eigen::MatrixXd::Zero(n, n);
  }

  Result<void> add(const Latent& latent) {
    if (std::holds_alternative<RateRamp>(latent.term.process)) return {};
    const auto block = unit_block(latent.term.process);
    if (!block) return tl::unexpected(block.error());
    const bool walks = std::holds_alternative<RandomWalk>(latent.term.process);
    const Index n = block->phi.rows();
    if (n == 0) {  // white noise: of the measurement alone
      add_white(latent, block->r);
      return {};
    }
    if (latent.matrix() || latent.sensors.size() == 1) {
      std::vector<Index> first(latent.sensors.size());
      for (std::size_t i = 0; i < latent.sensors.size(); ++i) {
        const Index sensor = latent.sensors[i];
        Index& bias = bias_[static_cast<std::size_t>(sensor)];
        // Two random walks of one sensor are one.
        first[i] = walks && bias >= 0 ? bias : append(*block, latent, sensor);
        if (walks) bias = first[i];
        if (walks) continue;
        system_.h.block(sensor, first[i], 1, n) = block->h;
      }
      for (std::size_t i = 0; i < first.size(); ++i) {
        for (std::size_t k = 0; k < first.size(); ++k) {
          const double power = latent.power(latent.sensors[i], latent.sensors[k]);
          system_.q.block(first[i], first[k], n, n) += power * block->q;
          system_.p0.block(first[i], first[k], n, n) += power * block->p0;
          system_.r(latent.sensors[i], latent.sensors[k]) += power * block->r;
        }
        if (walks) system_.h(latent.sensors[i], first[i]) = 1.0;
      }
      return {};
    }
    const Index first = append(*block, latent, -1);
    const double power = latent.scalar();
    system_.q.block(first, first, n, n) += power * block->q;
    system_.p0.block(first, first, n, n) += power * block->p0;
    for (const Index a : latent.sensors) {
      system_.h.block(a, first, 1, n) = block->h;
      for (const Index b : latent.sensors) system_.r(a, b) += power * block->r;
    }
    return {};
  }

  // A ramp moves the bias of the sensor's random walk, or one of its own.
  void add_ramp(const Latent& latent) {
    const double per_s = 1.0 / system_.dt;
    for (const Index sensor : latent.sensors) {
      Index& bias = bias_[static_cast<std::size_t>(sensor)];
      if (bias < 0) {
        bias = append_state("bias", sensor);
        system_.phi(bias, bias) = 1.0;
        system_.h(sensor, bias) = 1.0;
      }
      Index& slope = slope_[static_cast<std::size_t>(sensor)];
      if (slope < 0) slope = append_state("slope", sensor);
      system_.phi(slope, slope) = 1.0;
      system_.phi(bias, slope) = system_.dt;
    }
    for (const Index a : latent.sensors) {
      for (const Index b : latent.sensors) {
        system_.p0(slope_[static_cast<std::size_t>(a)], slope_[static_cast<std::size_t>(b)]) +=
            latent.power(a, b) * per_s * per_s;
      }
    }
  }

  StateSpace take() { return std::move(system_); }

 private:
  void add_white(const Latent& latent, double r) {
    const bool own = latent.matrix() || latent.sensors.size() == 1;
    for (const Index a : latent.sensors) {
      for (const Index b : latent.sensors)
        system_.r(a, b) += (own ? latent.power(a, b) : latent.scalar()) * r;
    }
  }

  // `sensor` < 0: a process that several share.
  Index append(const UnitBlock& block, const Latent& latent, Index sensor) {
    const Index first = system_.phi.rows();
    const Index n = block.phi.rows();
    const std::string name(info(latent.term.process).name);
    for (Index i = 0; i < n; ++i) {
      append_state(std::holds_alternative<RandomWalk>(latent.term.process) ? "bias"
                   : n == 1                                                ? name
                            : fmt::format("{}_{}", name, i + 1),
                   sensor);
    }
    system_.phi.block(first, first, n, n) = block.phi;
    return first;
  }

  Index append_state(const std::string& name, Index sensor) {
    const std::string whose =
        sensor < 0 ? "shared" : system_.outputs[static_cast<std::size_t>(sensor)];
    std::string unique = whose + "." + name;
    for (int i = 2;
         std::find(system_.states.begin(), system_.states.end(), unique) != system_.states.end();
         ++i)
      unique = fmt::format("{}.{}#{}", whose, name, i);
    system_.states.push_back(unique);
    grow(system_.phi, 1, 1);
    grow(system_.q, 1, 1);
    grow(system_.p0, 1, 1);
    grow(system_.h, 0, 1);
    return system_.phi.rows() - 1;
  }

  StateSpace system_;
  std::vector<Index> bias_;  // the state of each sensor; -1: none
  std::vector<Index> slope_;
};

}  // namespace

Result<StateSpace> state_space(const ArrayModel& noise, const std::vector<std::string>& outputs,
                               Hertz rate) {
  Assembly assembly(outputs, 1.0 / rate.value);
  for (const Latent& one : noise.latents) {
    if (auto added = assembly.add(one); !added) return tl::unexpected(added.error());
  }
  for (const Latent& one : noise.latents) {
    if (std::holds_alternative<RateRamp>(one.term.process)) assembly.add_ramp(one);
  }
  return assembly.take();
}

Result<StateSpace> state_space(const Model& noise, const std::string& output, Hertz rate) {
  ArrayModel one{1, {}};
  for (const Term& term : noise.terms) {
    Latent latent{term, 0, {0}, Eigen::MatrixXd::Constant(1, 1, values(term.process).front())};
    latent.term.sharing = Sharing::kOwn;
    one.latents.push_back(std::move(latent));
  }
  return state_space(one, {output}, rate);
}

StateSpace virtual_output(const StateSpace& array, const Eigen::VectorXd& weights) {
  StateSpace out = array;
  out.outputs = {"virtual"};
  out.h = weights.transpose() * array.h;
  out.r = weights.transpose() * array.r * weights;
  return out;
}

}  // namespace imunoise::study
