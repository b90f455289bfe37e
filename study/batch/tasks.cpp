#include "study/batch/tasks.h"

#include "core/effects/parse_full_model.h"

namespace imunoise::study {

CalibrateOptions calibrate_options(const v1::CalibrationSettings& settings, std::int64_t now_ns) {
  CalibrateOptions out;
  out.models.assign(settings.models().begin(), settings.models().end());
  if (!settings.array_model().empty()) out.array_model = settings.array_model();
  out.channels.assign(settings.channels().begin(), settings.channels().end());
  out.diagnose = settings.diagnose();
  out.array = settings.array();
  out.bootstrap.sets = static_cast<int>(settings.bootstrap_sets());
  out.bootstrap.seed = settings.seed();
  out.made_ns = now_ns;
  return out;
}

Result<Simulation> simulation_of(const v1::SimulationTask& task, std::uint32_t set) {
  const Hertz rate{task.rate_hz()};
  auto model = parse_full_model(task.model(), rate);
  if (!model) return tl::unexpected(model.error());
  return Simulation::make(std::move(*model),
                          {.samples = task.samples(),
                           .rate = rate,
                           .replicates = task.replicates(),
                           .first_stream = set * task.replicates()},
                          task.seed());
}

}  // namespace imunoise::study
