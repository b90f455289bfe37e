// A driver that loads well and then breaks the rules of driver.h as its option says.

#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "drivers/driver.h"

namespace {

const imunoise_channel kFloat = {
    sizeof(imunoise_channel), IMUNOISE_FLOAT64, "x", nullptr, "1", 1.0, 0.0};
const imunoise_channel* const kChannels[] = {&kFloat};
const imunoise_stream kStream = {sizeof(imunoise_stream), 1, "only", kChannels, 10.0, 255, 0.0};
const imunoise_stream* const kStreams[] = {&kStream};
const imunoise_device_info kDevice = {
    sizeof(imunoise_device_info), 1, kStreams, "faulty", nullptr, nullptr};
const imunoise_device_info kNoStreams = {
    sizeof(imunoise_device_info), 0, kStreams, nullptr, nullptr, nullptr};
const imunoise_option kFault = {sizeof(imunoise_option),
                                IMUNOISE_OPTION_TEXT,
                                IMUNOISE_OPTION_REQUIRED,
                                0,
                                "fault",
                                "What it does wrong",
                                nullptr,
                                nullptr,
                                nullptr,
                                0.0,
                                0.0};
const imunoise_option* const kOptions[] = {&kFault};

std::string fault;

std::int32_t open_device(const imunoise_option_value* const* values, std::uint32_t /*count*/,
                         void* /*context*/, imunoise_device** device, imunoise_error* error) {
  fault = values[0]->text;
  if (fault == "throw_in_open") throw std::runtime_error("out");
  if (fault == "endless_error") {
    std::memset(error->text, 'e', error->capacity);  // no final 0
    return IMUNOISE_NOT_FOUND;
  }
  if (fault == "latin1_error") {
    std::strncpy(error->text, "no sensor at 20 \xb0 C", error->capacity - 1);
    return IMUNOISE_NOT_FOUND;
  }
  if (fault == "no_handle") return IMUNOISE_OK;
  *device = static_cast<imunoise_device*>(static_cast<void*>(&fault));
  return IMUNOISE_OK;
}

std::int32_t describe(imunoise_device* /*device*/, const imunoise_device_info** info,
                      imunoise_error* /*error*/) {
  *info = fault == "no_streams" ? &kNoStreams : fault == "no_info" ? nullptr : &kDevice;
  return IMUNOISE_OK;
}

std::int32_t read_device(imunoise_device* /*device*/, std::int32_t /*timeout_ms*/,
                         imunoise_block* block, imunoise_error* error) {
  block->rows = 1;
  block->counter[0] = 255;
  static_cast<double*>(block->columns[0])[0] = 1.0;
  if (fault == "too_many_rows") block->rows = block->row_capacity + 1;
  if (fault == "unknown_stream") block->stream = 1;
  if (fault == "nan_number") static_cast<double*>(block->columns[0])[0] = std::nan("");
  if (fault == "counter_beyond") block->counter[0] = 256;
  if (fault == "nothing_at_all") block->rows = 0;
  if (fault == "samples_with_timeout") return IMUNOISE_TIMEOUT;
  if (fault == "throw_in_read") throw 42;
  if (fault == "unknown_status" || fault == "unknown_error" || fault == "gone") block->rows = 0;
  if (fault == "unknown_status") return 99;
  if (fault == "unknown_error") return -99;
  if (fault == "gone") {
    std::strncpy(error->text, "the cable was pulled", error->capacity - 1);
    return IMUNOISE_DISCONNECTED;
  }
  return IMUNOISE_OK;
}

void nothing(imunoise_device* /*device*/) {}

const imunoise_driver kDriver = {sizeof(imunoise_driver),
                                 IMUNOISE_DRIVER_ABI,
                                 "faulty",
                                 nullptr,
                                 nullptr,
                                 1,
                                 0,
                                 kOptions,
                                 nullptr,
                                 &open_device,
                                 &describe,
                                 &read_device,
                                 &nothing,
                                 &nothing};

}  // namespace

const imunoise_driver* imunoise_driver_entry(std::uint32_t /*host_abi*/,
                                             const imunoise_host* /*host*/) {
  return &kDriver;
}
