#pragma once

// Everything that a driver written in C++ needs. Derive from imunoise::plugin::Device, describe the
// driver, and end the file with one line:
//
//   IMUNOISE_DRIVER(describe_driver, open_device)
//
// docs/driver-guide.md goes through it. Header only; nothing in it may have a static variable of
// its own, for the dynamic linker would share that among plugins.

#include <exception>

#include "drivers/plugin/device.h"
#include "drivers/plugin/entry.h"
#include "drivers/plugin/options.h"

/// Makes a shared object a driver. `describe` is a function that returns
/// imunoise::drivers::DriverInfo; `open_function` one that is an imunoise::plugin::OpenFunction.
/// Once a shared object, outside of namespaces.
#define IMUNOISE_DRIVER(describe, open_function)                                                   \
  namespace {                                                                                      \
  const imunoise_host* imunoise_the_host = nullptr;                                                \
  std::int32_t imunoise_open(const imunoise_option_value* const* values, std::uint32_t count,      \
                             void* context, imunoise_device** device, imunoise_error* error) {     \
    return ::imunoise::plugin::Operations::open(open_function, imunoise_the_host, context, values, \
                                                count, device, error);                             \
  }                                                                                                \
  }                                                                                                \
  extern "C" const imunoise_driver* imunoise_driver_entry(std::uint32_t abi,                       \
                                                          const imunoise_host* host) {             \
    if (abi == IMUNOISE_DRIVER_ABI) imunoise_the_host = host;                                      \
    try {                                                                                          \
      static const auto* const driver =                                                            \
          new ::imunoise::plugin::Driver(describe(), &imunoise_open);                              \
      return driver->table();                                                                      \
    } catch (const std::exception&) {                                                              \
      return nullptr;                                                                              \
    }                                                                                              \
  }
