#include "recording/store/recorder/replicate_counts.h"

#include <fmt/core.h>

#include "core/support/counted.h"

namespace imunoise::recording {
namespace {

v1::StreamCount to_message(const std::string& device, const std::string& stream,
                           const StreamCounts& counts) {
  v1::StreamCount out;
  out.set_device(device);
  out.set_stream(stream);
  out.set_received(counts.received);
  out.set_stored(counts.stored);
  for (const Refusal& one : counts.refused) {
    if (one.reason != Refused::kNotWritten) *out.add_discarded() = to_message(one);
  }
  out.set_not_written(not_written(counts));
  return out;
}

}  // namespace

std::uint64_t not_written(const StreamCounts& counts) {
  std::uint64_t out = 0;
  for (const Refusal& one : counts.refused) {
    if (one.reason == Refused::kNotWritten) out += one.rows;
  }
  return out;
}

Result<void> check_written(const v1::RecordedDevice& device, const RecorderState& state,
                           std::size_t index) {
  std::uint64_t rows = 0;
  for (const StreamCounts& counts : state.counts[index]) rows += not_written(counts);
  if (rows == 0) return {};
  const std::optional<DiskTrouble>& trouble = state.disks[index].trouble;
  return fail(fmt::format("device {}: {} not written: {}", device.name(), counted(rows, "sample"),
                          trouble ? trouble->error.message : "the disk failed at the end"));
}

void interrupt(v1::ReplicateNote& note, const Error& reason) {
  note.set_state(v1::interrupted);
  note.set_reason((note.reason().empty() ? "" : note.reason() + "; ") + reason.message);
}

void settle_note(v1::ReplicateNote& note, const std::vector<v1::RecordedDevice>& devices,
                 const RecorderState& state) {
  note.clear_streams();
  for (std::size_t i = 0; i < devices.size(); ++i) {
    for (std::size_t k = 0; k < state.counts[i].size(); ++k) {
      *note.add_streams() = to_message(
          devices[i].name(), devices[i].streams(static_cast<int>(k)).name(), state.counts[i][k]);
    }
    if (auto written = check_written(devices[i], state, i); !written)
      interrupt(note, written.error());
  }
}

}  // namespace imunoise::recording
