#include "python/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/effects/parse_full_model.h"
#include "core/effects/simulation.h"
#include "core/support/units.h"
#include "python/job.h"
#include "recording/import/table/options.h"

namespace imunoise::python {
namespace {

namespace py = pybind11;

Unit unit_of(const std::string& text) { return text.empty() ? Unit{} : value_of(parse_unit(text)); }

Hertz rate_of(double rate) {
  if (!(rate > 0.0) || !std::isfinite(rate)) throw Failure("the rate must be above 0 Hz");
  return Hertz{rate};
}

recording::Channel channel_of(std::string name, std::vector<double> values, const Unit& unit,
                              Hertz rate) {
  recording::Channel out;
  out.name = std::move(name);
  out.count = values.size();
  out.samples = std::make_shared<const recording::Samples>(std::move(values));
  out.scale = unit.to_si;
  out.offset = unit.si_offset;
  out.unit = unit;
  out.rate = rate;
  return out;
}

std::vector<double> checked(const Samples& array, const std::string& name) {
  if (array.ndim() != 1)
    throw Failure(fmt::format("{}: expected one dimension, found {}", name, array.ndim()));
  const double* const begin = array.data();
  std::vector<double> out(begin, begin + array.size());
  if (out.size() < recording::kMinimumSamples)
    throw Failure(fmt::format("{}: {} samples; a replicate needs at least {}", name, out.size(),
                              recording::kMinimumSamples));
  const auto bad = std::find_if(out.begin(), out.end(), [](double x) { return !std::isfinite(x); });
  if (bad != out.end())
    throw Failure(fmt::format(
        "{}: sample {} is not finite; cut the array there and pass its parts as replicates", name,
        bad - out.begin()));
  return out;
}

}  // namespace

py::array_t<double> samples(const Recording& recording, std::size_t replicate,
                            std::size_t channel) {
  const recording::Channel& one = recording.channel(replicate, channel);
  const auto* const stored = std::get_if<std::vector<double>>(one.samples.get());
  if (stored != nullptr && one.scale == 1.0 && one.offset == 0.0) {
    auto* const owner = new std::shared_ptr<const recording::Samples>(one.samples);
    const py::capsule held(
        owner, [](void* p) { delete static_cast<std::shared_ptr<const recording::Samples>*>(p); });
    py::array_t<double> out(static_cast<py::ssize_t>(one.count), stored->data() + one.begin, held);
    out.attr("flags").attr("writeable") = false;
    return out;
  }
  py::array_t<double> out(static_cast<py::ssize_t>(one.count));
  std::visit(
      [&](const auto& values) {
        double* const to = out.mutable_data();
        for (std::size_t i = 0; i < one.count; ++i)
          to[i] = one.offset + one.scale * static_cast<double>(values[one.begin + i]);
      },
      *one.samples);
  out.attr("flags").attr("writeable") = false;
  return out;
}

Recording from_arrays(const NamedArrays& arrays, const std::vector<std::string>& units,
                      double rate) {
  if (arrays.empty() || arrays.front().second.empty()) throw Failure("there are no samples");
  Recording out;
  for (std::size_t r = 0; r < arrays.front().second.size(); ++r) {
    recording::Replicate one;
    one.name = fmt::format("replicate {}", r + 1);
    one.rate = rate_of(rate);
    for (std::size_t c = 0; c < arrays.size(); ++c) {
      const auto& [name, parts] = arrays[c];
      if (parts.size() != arrays.front().second.size())
        throw Failure(name + ": has another number of replicates than the first channel");
      const std::string where =
          parts.size() > 1 ? fmt::format("{}, replicate {}", name, r + 1) : name;
      one.channels.push_back(
          channel_of(name, checked(parts[r], where), unit_of(units.at(c)), one.rate));
      if (one.channels.back().count != one.channels.front().count)
        throw Failure(fmt::format("{}: {} samples in replicate {}, but {} has {}", name,
                                  one.channels.back().count, r + 1, one.channels.front().name,
                                  one.channels.front().count));
    }
    out.replicates.push_back(std::move(one));
  }
  return out;
}

Recording simulated(const std::string& model, double rate, std::size_t samples,
                    std::uint32_t replicates, std::uint64_t seed, const std::string& unit,
                    const std::string& channel, const py::object& progress) {
  const Hertz hertz = rate_of(rate);
  if (samples < recording::kMinimumSamples || replicates == 0)
    throw Failure(fmt::format("a simulation has at least {} samples and 1 replicate",
                              recording::kMinimumSamples));
  Unit si = unit_of(unit);
  if (si.to_si != 1.0 || si.si_offset != 0.0)
    throw Failure(unit + ": a model is in SI; name the SI unit");
  const Simulation simulation = value_of(Simulation::make(value_of(parse_full_model(model, hertz)),
                                                          {samples, hertz, replicates}, seed));
  const auto draw = [&](const Progress& told) -> Result<Recording> {
    Recording out;
    for (std::uint32_t r = 0; r < replicates; ++r) {
      if (told.stopped()) return fail("stopped");
      recording::Replicate one;
      one.name = fmt::format("{}_{}", channel, r + 1);
      one.rate = hertz;
      one.channels.push_back(channel_of(channel, simulation.replicate(r).channel, si, hertz));
      out.replicates.push_back(std::move(one));
      told.report(static_cast<double>(r + 1) / replicates);
    }
    return out;
  };
  return run(draw, progress);
}

}  // namespace imunoise::python
