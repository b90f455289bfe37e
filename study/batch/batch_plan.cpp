#include "study/batch/batch_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/effects/parse_full_model.h"
#include "core/support/counted.h"
#include "study/batch/tasks.h"

namespace imunoise::study {
namespace {

std::uint32_t item_count(const v1::Batch& batch) {
  return batch.has_simulate() ? batch.simulate().sets()
                              : static_cast<std::uint32_t>(batch.calibrate().recordings_size());
}

std::uint32_t shards_for(std::uint32_t items, std::uint32_t size) {
  return items / size + (items % size > 0 ? 1 : 0);
}

Result<void> check_simulation(const v1::SimulationTask& task) {
  if (auto truth = simulation_of(task, 0); !truth) return tl::unexpected(truth.error());
  const auto fitted = parse_full_model(task.fit(), Hertz{task.rate_hz()});
  if (!fitted) return tl::unexpected(fitted.error());
  // Each replicate of each set has a random stream of its own, named by 32 bits.
  if (std::uint64_t{task.sets()} * task.replicates() > UINT32_MAX)
    return fail(fmt::format("{} of {}: at most 2^32 replicates in all", counted(task.sets(), "set"),
                            counted(task.replicates(), "replicate")));
  return {};
}

// Part number `number` of the task.
v1::CalibrationTask part_of(const v1::CalibrationTask& task, std::uint32_t first,
                            std::uint32_t count) {
  v1::CalibrationTask out;
  *out.mutable_settings() = task.settings();
  const auto begin = task.recordings().begin() + static_cast<std::ptrdiff_t>(first);
  out.mutable_recordings()->Add(begin, begin + static_cast<std::ptrdiff_t>(count));
  return out;
}

v1::SimulationTask part_of(const v1::SimulationTask& task, std::uint32_t first,
                           std::uint32_t count) {
  v1::SimulationTask out = task;
  out.set_first_set(task.first_set() + first);
  out.set_sets(count);
  return out;
}

}  // namespace

Result<std::string> form_of(const std::string& model, double rate_hz) {
  auto form = parse_full_model(model, Hertz{rate_hz});
  if (!form) return tl::unexpected(form.error());
  for (Term& term : form->noise.terms) term.given.assign(term.given.size(), false);
  for (EffectTerm& term : form->effects) term = shape_of(std::move(term));
  return print(*form);
}

std::uint32_t default_shard_size(const v1::Batch& batch) {
  const std::uint32_t shards = batch.has_simulate() ? 100 : kMostShards;
  return std::max(1U, shards_for(item_count(batch), shards));
}

Result<void> check_batch(const v1::Batch& batch) {
  const std::uint32_t items = item_count(batch);
  if (items == 0) return fail("batch: no recordings and no simulation");
  if (batch.shard_size() == 0) return fail("batch: a shard has at least one piece of work");
  if (const std::uint32_t shards = shards_for(items, batch.shard_size()); shards > kMostShards) {
    return fail(fmt::format("batch: {} shards; at most {}: make them larger (--shard-size {})",
                            shards, kMostShards, shards_for(items, kMostShards)));
  }
  if (batch.has_simulate()) return check_simulation(batch.simulate());
  return check_models(calibrate_options(batch.calibrate().settings(), 0));
}

std::vector<v1::BatchShard> shards_of(const v1::Batch& batch) {
  std::vector<v1::BatchShard> out;
  const std::uint32_t items = item_count(batch);
  for (std::uint32_t first = 0; first < items; first += batch.shard_size()) {
    const std::uint32_t count = std::min(batch.shard_size(), items - first);
    v1::BatchShard& shard = out.emplace_back();
    shard.set_version(kBatchVersion);
    shard.set_number(static_cast<std::uint32_t>(out.size() - 1));
    if (batch.has_simulate()) {
      *shard.mutable_simulate() = part_of(batch.simulate(), first, count);
    } else {
      *shard.mutable_calibrate() = part_of(batch.calibrate(), first, count);
    }
  }
  return out;
}

}  // namespace imunoise::study
