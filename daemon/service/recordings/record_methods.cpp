#include "daemon/service/recordings/record_methods.h"

namespace imunoise::service {

void add_record_methods(Methods& methods, Records& records) {
  methods.on_waiting<v1::ListRecordingsRequest>(
      [&records](const v1::ListRecordingsRequest& request) {
        return records.recordings(request.campaign());
      });
  methods.on_waiting<v1::GetRecordingRequest>([&records](const v1::GetRecordingRequest& request) {
    return records.manifest(request.campaign(), request.folder());
  });
  methods.on_waiting<v1::ListCalibrationsRequest>(
      [&records](const v1::ListCalibrationsRequest& request) {
        return records.calibrations(request.campaign());
      });
  methods.on_waiting<v1::GetCalibrationRequest>(
      [&records](const v1::GetCalibrationRequest& request) {
        return records.calibration(request.campaign(), request.folder());
      });
  methods.on_waiting<v1::ListArraysRequest>([&records](const v1::ListArraysRequest& request) {
    return records.arrays(request.campaign());
  });
  methods.on_waiting<v1::GetArraysRequest>(
      [&records](const v1::GetArraysRequest& request) -> Answer<v1::ArrayCalibrations> {
        auto calibration = records.calibration(request.campaign(), request.folder());
        if (!calibration) return tl::unexpected(calibration.error());
        v1::ArrayCalibrations out;
        out.mutable_arrays()->Swap(calibration->mutable_arrays());
        return out;
      });
  methods.on_waiting<v1::GetArrayFigureRequest>(
      [&records](const v1::GetArrayFigureRequest& request) {
        return records.array_figure(request);
      });
  methods.on_waiting<v1::GetSamplesRequest>(
      [&records](const v1::GetSamplesRequest& request) { return records.samples(request); });
  methods.on_waiting<v1::GetFleetRequest>(
      [&records](const v1::GetFleetRequest& request) { return records.fleet(request); });
  methods.on_waiting<v1::GetFleetFigureRequest>(
      [&records](const v1::GetFleetFigureRequest& request) {
        return records.fleet_figure(request);
      });
  methods.on_waiting<v1::GetHistoryRequest>(
      [&records](const v1::GetHistoryRequest& request) { return records.history(request); });
  methods.on_waiting<v1::GetHistoryFigureRequest>(
      [&records](const v1::GetHistoryFigureRequest& request) {
        return records.history_figure(request);
      });
}

}  // namespace imunoise::service
