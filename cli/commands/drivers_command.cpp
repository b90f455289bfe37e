#include <fmt/format.h>

#include "cli/commands/commands.h"
#include "cli/output.h"
#include "daemon/service/campaigns/driver_report.h"
#include "study/report/json.h"
#include "study/words/text.h"

namespace imunoise::cli {
namespace {

// Type, unit, range and default: "number, s, 0 to 10, default 0.01".
std::string allowed(const v1::DriverOption& option) {
  std::string out = v1::OptionType_Name(option.type());
  if (!option.unit().empty()) out += ", " + option.unit();
  if (option.choices_size() > 0) out = fmt::format("{}", fmt::join(option.choices(), " | "));
  if (option.has_minimum() && option.has_maximum()) {
    out += fmt::format(", {} to {}", option.minimum(), option.maximum());
  } else if (option.has_minimum()) {
    out += fmt::format(", at least {}", option.minimum());
  } else if (option.has_maximum()) {
    out += fmt::format(", at most {}", option.maximum());
  }
  if (option.has_default_value()) out += ", default " + option.default_value();
  if (option.required()) out += ", required";
  if (option.repeated()) out += ", repeatable";
  return out;
}

std::string stream_text(const v1::DriverStream& stream) {
  std::string channels;
  for (const v1::DriverChannel& channel : stream.channels()) {
    channels +=
        fmt::format("{}{} [{}]", channels.empty() ? "" : ", ", channel.name(), channel.units());
  }
  const std::string rate =
      stream.nominal_rate_hz() > 0.0 ? fmt::format(" at {:g} Hz", stream.nominal_rate_hz()) : "";
  return fmt::format("  stream {}{}: {}\n", stream.name(), rate, channels);
}

std::string report_text(const v1::DriversReport& report) {
  std::string out;
  for (const v1::Driver& driver : report.drivers()) {
    out += fmt::format("{} {}: {}\n", driver.name(), driver.version(), driver.description());
    out += fmt::format("  {}\n", driver.file());
    for (const v1::DriverOption& option : driver.options()) {
      out +=
          fmt::format("  {:<12} {} ({})\n", option.name(), option.description(), allowed(option));
    }
    for (const v1::DriverStream& stream : driver.streams()) out += stream_text(stream);
    out += "\n";
  }
  for (const v1::RefusedDriver& plugin : report.refused()) {
    out += fmt::format("not loaded: {}: {}\n", plugin.file(), report::clean_text(plugin.reason()));
  }
  if (report.drivers().empty()) out += "no drivers found\n";
  return out + fmt::format("searched: {}\n", fmt::join(report.folders(), ", "));
}

}  // namespace

int run(const DriversArguments& arguments) {
  const v1::DriversReport report =
      service::driver_report(drivers::load_drivers(drivers::driver_folders(arguments.folders)));
  if (arguments.names_only) {
    for (const v1::Driver& driver : report.drivers()) print(driver.name() + "\n");
    return 0;
  }
  print(arguments.json ? report::to_json(report) : report_text(report));
  return 0;
}

}  // namespace imunoise::cli
