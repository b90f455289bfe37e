#include <fmt/format.h>

#include <cmath>

#include "cli/commands.h"
#include "cli/output.h"
#include "drivers/host/load.h"
#include "imunoise/v1/drivers.pb.h"
#include "study/report/json.h"
#include "study/report/text.h"

namespace imunoise::cli {
namespace {

v1::DriverStream stream_message(const drivers::Stream& stream) {
  v1::DriverStream out;
  out.set_name(stream.name);
  out.set_nominal_rate_hz(stream.nominal_rate_hz);
  out.set_counter_maximum(stream.counter_maximum);
  out.set_device_time_tick_s(stream.device_time_tick_s);
  for (const drivers::Channel& channel : stream.channels) {
    v1::DriverChannel& message = *out.add_channels();
    message.set_name(channel.name);
    message.set_units(channel.units);
    message.set_number_type(static_cast<v1::NumberType>(channel.type));
    message.set_scale_factor(channel.scale_factor);
    message.set_add_offset(channel.add_offset);
    message.set_long_name(channel.long_name);
  }
  return out;
}

v1::DriverOption option_message(const drivers::Option& option) {
  v1::DriverOption out;
  out.set_name(option.name);
  out.set_type(static_cast<v1::OptionType>(option.type));
  out.set_description(option.description);
  out.set_unit(option.unit);
  if (option.by_default) out.set_default_value(*option.by_default);
  out.set_required(option.required);
  out.set_repeated(option.repeated);
  if (std::isfinite(option.minimum)) out.set_minimum(option.minimum);
  if (std::isfinite(option.maximum)) out.set_maximum(option.maximum);
  for (const std::string& choice : option.choices) out.add_choices(choice);
  return out;
}

v1::DriversReport report_message(const drivers::Drivers& drivers) {
  v1::DriversReport out;
  for (const auto& folder : drivers.folders) out.add_folders(folder.string());
  for (const drivers::Driver& driver : drivers.found) {
    v1::Driver& message = *out.add_drivers();
    message.set_name(driver.info.name);
    message.set_description(driver.info.description);
    message.set_version(driver.info.version);
    message.set_file(driver.file.string());
    for (const auto& option : driver.info.options) *message.add_options() = option_message(option);
    for (const auto& stream : driver.info.streams) *message.add_streams() = stream_message(stream);
  }
  for (const drivers::RefusedPlugin& plugin : drivers.refused) {
    v1::RefusedDriver& message = *out.add_refused();
    message.set_file(plugin.file.string());
    message.set_reason(plugin.reason);
  }
  return out;
}

// What may be given: "number, s, 0 to 10, default 0.01".
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
  if (option.repeated()) out += ", may be repeated";
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
    out += fmt::format("refused: {}: {}\n", plugin.file(), report::clean_text(plugin.reason()));
  }
  if (report.drivers().empty()) out += "no drivers found\n";
  return out + fmt::format("searched: {}\n", fmt::join(report.folders(), ", "));
}

}  // namespace

int run(const DriversArguments& arguments) {
  const v1::DriversReport report =
      report_message(drivers::load_drivers(drivers::driver_folders(arguments.folders)));
  print(arguments.json ? report::to_json(report) : report_text(report));
  return 0;
}

}  // namespace imunoise::cli
