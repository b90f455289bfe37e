#include <fmt/format.h>

#include <map>

#include "study/report/documents/array_tables.h"
#include "study/report/documents/catalogue_documents.h"
#include "study/report/documents/diagnosis_words.h"
#include "study/report/documents/preflight_section.h"
#include "study/report/figures/budget_figure.h"
#include "study/report/view/bias_instability.h"
#include "study/report/view/coefficient_words.h"
#include "study/report/view/verdict.h"
#include "study/words/number.h"

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

// N, B and K of every channel in units of data sheets, and in SI beneath. Other coefficients share
// a cell.
void add_noise(const v1::ChannelCalibration& channel, UnitSystem system, Digits digits, Table& to) {
  std::map<std::string, std::string> by_symbol;
  std::string others;
  for (const v1::Term& term : channel.fit().terms()) {
    for (const v1::Coefficient& one : term.coefficients()) {
      const std::string words = short_words(one, digits, system);
      const bool known = one.symbol() == "N" || one.symbol() == "B" || one.symbol() == "K";
      if (known && by_symbol[one.symbol()].empty())
        by_symbol[one.symbol()] = words;
      else
        others += fmt::format("{}{} {}", others.empty() ? "" : ", ", one.symbol(), words);
    }
  }
  std::string minimum;
  for (const v1::BiasInstability& one : channel.fit().bias_instability())
    if (one.kind() == "minimum" && one.has_value())
      minimum = (one.at_edge() ? "at most " : "") + short_words(one.value(), digits, system);
  to.rows.push_back({system == UnitSystem::kDatasheet ? channel.channel() : "", by_symbol["N"],
                     by_symbol["B"], minimum, by_symbol["K"], others});
}

Table noise(const v1::Calibration& calibration, Digits digits) {
  Table out{"Noise of all channels, in units of data sheets and in SI",
            {"channel", "N", "B", "minimum / 0.664", "K", "others"},
            {}};
  for (const v1::ChannelCalibration& one : calibration.channels()) {
    if (!one.has_fit()) continue;
    add_noise(one, UnitSystem::kDatasheet, digits, out);
    add_noise(one, UnitSystem::kSi, digits, out);
  }
  return out;
}

figure::Figure allan_figure(const v1::FitReport& fit) {
  const Verdict fits = verdict(fit);
  figure::Figure out =
      budget_figure(as_allan(budget_view(fit), allan_unit(fit.unit())),
                    {.channel = fit.channel(),
                     .unit = allan_unit(fit.unit()).unit,
                     .confidence = fit.confidence(),
                     .mark_misfits = fits == Verdict::kFails || fits == Verdict::kDoubtful,
                     .allan = true});
  out.title = "Allan deviation";
  return out;
}

Table instabilities(const v1::FitReport& fit, Digits digits) {
  Table out{"Bias instability", {"", "value", ""}, {}};
  for (const BiasInstability& one : bias_instabilities(fit, digits))
    out.rows.push_back({one.meaning, one.value, one.remark});
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
    out.figures.push_back(allan_figure(channel.fit()));
    out.tables.push_back(coefficients(channel.fit(), digits));
    if (Table known = instabilities(channel.fit(), digits); !known.rows.empty())
      out.tables.push_back(std::move(known));
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
                        one.averaged() == 1 ? "no" : counted(one.averaged(), "sample"),
                        counted(one.dropped(), "sample")});
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
  all.title = "all channels";
  if (calibration.started_ns() != 0)
    all.facts = fmt::format("recorded {} · ", minute(calibration.started_ns()));
  all.facts += fmt::format("calibrated {} UTC", minute(calibration.made_ns()));
  all.summary = calibration.summary();
  all.tables = {overview(calibration)};
  if (Table known = noise(calibration, digits); !known.rows.empty())
    all.tables.push_back(std::move(known));
  Document out{"calibration", {all}};
  for (const v1::ChannelCalibration& one : calibration.channels())
    out.sections.push_back(channel_section(one, digits));
  for (const v1::ArrayCalibration& one : calibration.arrays())
    out.sections.push_back(array_section(one, digits));
  add_files(calibration.preflight(), digits, out);
  return out;
}

}  // namespace imunoise::report
