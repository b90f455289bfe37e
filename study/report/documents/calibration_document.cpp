#include <fmt/format.h>

#include "study/report/documents/array_tables.h"
#include "study/report/documents/catalogue_documents.h"
#include "study/report/documents/diagnosis_words.h"
#include "study/report/documents/preflight_section.h"
#include "study/report/view/verdict.h"

namespace imunoise::report {
namespace {

Mood mood_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kFits:
      return Mood::kGood;
    case Verdict::kDoubtful:
      return Mood::kDoubtful;
    case Verdict::kFails:
      return Mood::kBad;
    case Verdict::kUntested:
      break;
  }
  return Mood::kNeutral;
}

std::string alike_words(const v1::ChannelCalibration& channel) {
  if (!channel.has_stationarity()) return "not tested";
  return channel.stationarity().heterogeneity().rejected() ? "they differ" : "alike";
}

Table overview(const v1::Calibration& calibration) {
  Table out{"Channels", {"channel", "model", "fit", "replicates", "missing effect"}, {}};
  for (const v1::ChannelCalibration& one : calibration.channels()) {
    const bool fitted = one.has_fit();
    out.rows.push_back(
        {one.channel(), fitted ? one.fit().model() : "none",
         fitted ? std::string(verdict_words(verdict(one.fit()))) : "no model", alike_words(one),
         one.has_diagnosis() ? diagnosis_words(one.diagnosis()).badge : "not sought"});
  }
  return out;
}

Table coefficients(const v1::FitReport& fit, Digits digits) {
  Table out{"Noise", {"", "value", "95 % interval", "unit"}, {}};
  for (const v1::Term& term : fit.terms()) {
    for (const v1::Coefficient& one : term.coefficients()) {
      const bool si = one.datasheet_unit().empty();
      const double value = si ? one.value() : one.datasheet_value();
      const double lower = si ? one.lower() : one.datasheet_lower();
      const double upper = si ? one.upper() : one.datasheet_upper();
      out.rows.push_back(
          {fmt::format("{}, {}", one.symbol(), one.title()), rounded(value, lower, upper, digits),
           interval(value, lower, upper, digits), si ? one.unit() : one.datasheet_unit()});
    }
  }
  return out;
}

Table in_words(const v1::ChannelCalibration& channel) {
  Table out{"What else is known", {"", ""}, {}};
  if (channel.has_choice()) out.rows.push_back({"model", channel.choice().summary()});
  if (!channel.missing().empty()) out.rows.push_back({"to fit", channel.missing()});
  if (channel.has_stationarity())
    out.rows.push_back({"replicates", channel.stationarity().summary()});
  if (channel.has_diagnosis()) {
    out.rows.push_back({"missing effect", channel.diagnosis().summary()});
    if (channel.diagnosis().verdict() != v1::none) {
      for (const v1::EffectCandidate& one : channel.diagnosis().candidates()) {
        if (beyond_chance(one)) out.rows.push_back({one.effect(), one.sentence()});
      }
    }
  }
  return out;
}

void add_troubles(const google::protobuf::RepeatedPtrField<v1::CalibrationTrouble>& from,
                  Section& to) {
  for (const v1::CalibrationTrouble& one : from)
    to.notes.push_back(fmt::format("{}: {}", one.step(), one.message()));
}

Section channel_section(const v1::ChannelCalibration& channel, Digits digits) {
  Section out;
  out.title = channel_name(channel.channel());
  if (channel.has_fit()) {
    const Verdict fits = verdict(channel.fit());
    out.badge = verdict_words(fits);
    out.mood = mood_of(fits);
    out.facts = facts(channel.fit());
    out.summary = verdict_sentence(channel.fit());
    out.tables.push_back(coefficients(channel.fit(), digits));
  } else {
    out.badge = "no model";
    out.mood = Mood::kBad;
    out.summary = "No model could be fitted to this channel; the notes say why.";
  }
  if (Table words = in_words(channel); !words.rows.empty()) out.tables.push_back(std::move(words));
  add_troubles(channel.troubles(), out);
  return out;
}

Table clocks_table(const v1::ArrayJoin& join, Digits digits) {
  Table out{"How the devices' clocks were brought together",
            {"device", "rate", "recorded", "clock", "averaged", "left out"},
            {}};
  for (const v1::JoinedStream& one : join.streams()) {
    out.rows.push_back({one.device(), fmt::format("{:g} Hz", one.rate_hz()),
                        duration(one.seconds()), number(one.clock_ppm(), 2, digits) + " ppm",
                        one.averaged() == 1 ? "no" : fmt::format("{} samples", one.averaged()),
                        fmt::format("{} samples", one.dropped())});
  }
  return out;
}

Section array_section(const v1::ArrayCalibration& array, Digits digits) {
  Section out;
  out.title = "array of " + joined(array.channels());
  out.summary = array.has_report() ? array.report().summary() : "The array could not be fitted.";
  if (array.has_join()) {
    out.facts = duration(array.join().seconds()) + " together";
    out.tables.push_back(clocks_table(array.join(), digits));
  }
  add_troubles(array.troubles(), out);
  return out;
}

}  // namespace

Document document(const v1::Calibration& calibration, Digits digits) {
  Section all;
  all.title = "calibration";
  all.facts = fmt::format("recorded {} · calibrated {} UTC", minute(calibration.started_ns()),
                          minute(calibration.made_ns()));
  all.summary = calibration.summary();
  all.tables = {overview(calibration)};
  Document out{"calibration", {all}};
  for (const v1::ChannelCalibration& one : calibration.channels())
    out.sections.push_back(channel_section(one, digits));
  for (const v1::ArrayCalibration& one : calibration.arrays())
    out.sections.push_back(array_section(one, digits));
  add_files(calibration.preflight(), digits, out);
  return out;
}

}  // namespace imunoise::report
