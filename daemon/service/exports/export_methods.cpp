#include "daemon/service/exports/export_methods.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "imunoise/v1/service.pb.h"
#include "study/export/export.h"
#include "study/export/known_consumers.h"
#include "study/export/sha256.h"
#include "study/export/source.h"
#include "study/ladder/study_file.h"

namespace imunoise::service {
namespace {

// It has a place for noise values, and its file is a text.
bool is_offered(const study::Consumer& one) {
  return (one.write != nullptr || one.holding != study::Holding::kDensities) &&
         !one.file.ends_with(".npz");
}

v1::ConsumerList consumer_list() {
  v1::ConsumerList out;
  for (const study::Consumer* const one : study::known_consumers()) {
    if (!is_offered(*one)) continue;
    v1::ExportConsumer& to = *out.add_consumers();
    to.set_name(std::string(one->name));
    to.set_title(std::string(one->title));
    to.set_file(std::string(one->file));
    to.set_holds(std::string(one->holds));
    to.set_remark(std::string(one->remark));
  }
  return out;
}

Answer<v1::Text> exported(const std::vector<study::SourceFit>& fits, const std::string& consumer,
                          const study::ExportSource& source, bool conservative) {
  const study::Consumer* const to = study::consumer_called(consumer);
  if (to == nullptr)
    return refuse(404, fmt::format("consumer: '{}' is unknown; there are {}", consumer,
                                   study::consumer_names()));
  if (!is_offered(*to))
    return refuse(409, fmt::format("consumer: there is no text for {}; use imunoise export --to {}",
                                   to->title, consumer));
  const auto imu = study::imu_noise(fits);
  if (!imu) return refuse(409, imu.error().message);
  study::ExportOptions options;
  options.conservative = conservative;
  auto text = study::export_noise(*imu, *to, source, options);
  if (!text) return refuse(409, text.error().message);
  v1::Text out;
  out.set_text(std::move(*text));
  return out;
}

Answer<v1::Text> export_recording(const Records& records,
                                  const v1::ExportRecordingRequest& request) {
  const auto known = records.calibration(request.campaign(), request.folder());
  if (!known) return tl::unexpected(known.error());
  const auto text = records.calibration_text(request.campaign(), request.folder());
  if (!text) return tl::unexpected(text.error());
  const auto fits = study::chosen_fits(study::fits_of(*known), request.device(),
                                       {request.channel().begin(), request.channel().end()});
  if (!fits) return refuse(404, fits.error().message);
  return exported(
      *fits, request.consumer(),
      {fmt::format("{}/{}", request.campaign(), request.folder()), study::sha256(*text)},
      request.conservative());
}

// The model that the study looks at, of one channel and without intervals.
v1::FitReport fit_of(const v1::Study& study, const v1::Rung& rung) {
  v1::FitReport out;
  out.set_channel(study.channel());
  out.set_unit(study.unit());
  out.set_rate_hz(study.rate_hz());
  out.set_model(rung.model());
  out.set_fitted_model(rung.fitted_model());
  out.set_confidence(0.95);
  *out.mutable_terms() = rung.picture().terms();
  return out;
}

Answer<v1::Text> export_study(const StudyStore& studies, const v1::ExportStudyRequest& request) {
  const auto study = studies.read(request.study());
  if (!study) return tl::unexpected(study.error());
  const v1::Rung& rung = study->attempts(static_cast<int>(study->current())).rung();
  return exported({study::SourceFit{"", fit_of(*study, rung)}}, request.consumer(),
                  {request.study() + ".study", study::sha256(study::study_text(*study))},
                  request.conservative());
}

}  // namespace

void add_export_methods(Methods& methods, const Records& records, const StudyStore& studies) {
  methods.on<v1::ListConsumersRequest>(
      [](const v1::ListConsumersRequest&) -> Answer<v1::ConsumerList> { return consumer_list(); });
  methods.on_waiting<v1::ExportRecordingRequest>(
      [&records](const v1::ExportRecordingRequest& request) {
        return export_recording(records, request);
      });
  methods.on_waiting<v1::ExportStudyRequest>(
      [&studies](const v1::ExportStudyRequest& request) { return export_study(studies, request); });
}

}  // namespace imunoise::service
