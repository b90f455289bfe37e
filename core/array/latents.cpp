#include "core/array/latents.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace imunoise {
namespace {

Latent latent_of(const Term& term, std::size_t written, std::vector<Eigen::Index> sensors,
                 Eigen::Index count) {
  Latent out{term, written, std::move(sensors), Eigen::MatrixXd::Zero(count, count)};
  std::vector<double> v = values(term.process);
  const double power = term.given[0] ? v[0] : 1.0;
  v[0] = 1.0;
  set_values(out.term.process, v);
  if (out.matrix()) {
    out.power.setIdentity();
  } else {
    out.set_scalar(power);
  }
  return out;
}

std::vector<double> shape_values(const Latent& latent) {
  const std::vector<double> v = values(latent.term.process);
  return {v.begin() + 1, v.end()};
}

}  // namespace

bool Latent::acts_on(Eigen::Index sensor) const {
  return std::find(sensors.begin(), sensors.end(), sensor) != sensors.end();
}

void Latent::set_scalar(double value) {
  for (const Eigen::Index a : sensors) {
    for (const Eigen::Index b : sensors) power(a, b) = value;
  }
}

ArrayModel expand(const Model& written, const ArrayLayout& layout) {
  ArrayModel out;
  out.sensors = static_cast<Eigen::Index>(layout.sensors);
  std::vector<Eigen::Index> all(layout.sensors);
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  std::map<std::size_t, std::vector<Eigen::Index>> groups;
  for (const Eigen::Index i : all) {
    groups[layout.group.empty() ? 0 : layout.group[static_cast<std::size_t>(i)]].push_back(i);
  }
  for (std::size_t t = 0; t < written.terms.size(); ++t) {
    Term term = written.terms[t];
    const bool ramp = std::holds_alternative<RateRamp>(term.process);
    if (ramp && term.sharing == Sharing::kOwn) term.sharing = Sharing::kCorrelated;
    const auto add = [&](const std::vector<Eigen::Index>& sensors) {
      out.latents.push_back(latent_of(term, t, sensors, out.sensors));
    };
    switch (term.sharing) {
      case Sharing::kOwn:
        for (const Eigen::Index i : all) add({i});
        break;
      case Sharing::kGroup:
        for (const auto& [name, sensors] : groups) add(sensors);
        break;
      case Sharing::kCorrelated:
      case Sharing::kAll:
        add(all);
        break;
    }
  }
  return out;
}

std::vector<Eigen::MatrixXd> covariance(const ArrayModel& model, const Scales& scales) {
  const Eigen::ArrayXd m = scales.half_widths();
  std::vector<Eigen::MatrixXd> out(scales.size(),
                                   Eigen::MatrixXd::Zero(model.sensors, model.sensors));
  for (const Latent& latent : model.latents) {
    const Eigen::ArrayXd at = shape(latent.term.process, m);
    for (std::size_t j = 0; j < out.size(); ++j) {
      out[j] += at(static_cast<Eigen::Index>(j)) * latent.power;
    }
  }
  return out;
}

ArrayModel sorted(ArrayModel model) {
  for (std::size_t i = 0; i < model.latents.size(); ++i) {
    for (std::size_t k = i + 1; k < model.latents.size(); ++k) {
      Latent& a = model.latents[i];
      Latent& b = model.latents[k];
      if (a.term.process.index() == b.term.process.index() && a.term.given == b.term.given &&
          a.term.sharing == b.term.sharing && a.sensors == b.sensors &&
          shape_values(a) < shape_values(b)) {
        std::swap(a.term, b.term);
        std::swap(a.power, b.power);
      }
    }
  }
  return model;
}

}  // namespace imunoise
