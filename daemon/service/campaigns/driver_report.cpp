#include "daemon/service/campaigns/driver_report.h"

#include <cmath>

namespace imunoise::service {
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

}  // namespace

v1::DriversReport driver_report(const drivers::Drivers& drivers) {
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

}  // namespace imunoise::service
