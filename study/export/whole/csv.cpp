#include <fmt/format.h>

#include "study/export/consumer.h"

namespace imunoise::study::consumers {
namespace {

std::string number_or_nothing(const Bounded& value, double Bounded::*end, double factor) {
  return value.bounded() ? fmt::format("{:.9g}", value.*end * factor) : "";
}

std::string csv_file(const Sheet& sheet) {
  std::string out = commented(sheet, "#") +
                    "channel,term,symbol,title,value,lower,upper,unit,datasheet_value,"
                    "datasheet_lower,datasheet_upper,datasheet_unit,rate_hz\n";
  for (const SensorNoise* const sensor : {&sheet.imu.gyro, &sheet.imu.accelerometer}) {
    for (const AxisNoise& axis : sensor->axes) {
      for (const CoefficientRow& row : axis.coefficients) {
        const Bounded& v = row.value;
        const double factor = row.to_datasheet;
        const bool customary = !row.datasheet_unit.empty();
        out += fmt::format("{},{},{},{},{:.9g},{},{},{},", axis.channel, row.term, row.symbol,
                           row.title, v.value, number_or_nothing(v, &Bounded::lower, 1.0),
                           number_or_nothing(v, &Bounded::upper, 1.0), row.unit);
        out += customary ? fmt::format("{:.9g},{},{}", v.value * factor,
                                       number_or_nothing(v, &Bounded::lower, factor),
                                       number_or_nothing(v, &Bounded::upper, factor))
                         : ",,";
        out += fmt::format(",{},{:.9g}\n", row.datasheet_unit, axis.rate.value);
      }
    }
  }
  return out;
}

}  // namespace

const Consumer& csv() {
  static const Consumer kConsumer{
      .name = "csv",
      .title = "CSV",
      .file = "noise.csv",
      .holds = "every coefficient with its interval, in SI and in the units of data sheets",
      .holding = Holding::kTerms,
      .axes = AxisRule::kEach,
      .write = csv_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
