/* A sound driver in plain C99, until the statement SPOIL spoils one thing of it. */

#include <math.h>
#include <string.h>

#include "drivers/driver.h"

static imunoise_channel channel = {
    sizeof(imunoise_channel), IMUNOISE_INT16, "gyro_x", "angular rate about x", "rad/s", 0.5, 0.0};
static imunoise_channel second = {
    sizeof(imunoise_channel), IMUNOISE_FLOAT32, "temperature", 0, "K", 1.0, 273.15};
static const imunoise_channel* channels[] = {&channel, &second};
static imunoise_stream stream = {sizeof(imunoise_stream), 2, "imu", channels, 100.0, 65535, 1e-4};
static const imunoise_stream* streams[] = {&stream};
static imunoise_option option = {sizeof(imunoise_option),
                                 IMUNOISE_OPTION_INTEGER,
                                 0,
                                 0,
                                 "rate",
                                 "Samples a second",
                                 "Hz",
                                 "100",
                                 0,
                                 1.0,
                                 1000.0};
static const imunoise_option* options[] = {&option};

static int32_t open_device(const imunoise_option_value* const* values, uint32_t value_count,
                           void* context, imunoise_device** device, imunoise_error* error) {
  (void)values, (void)value_count, (void)context, (void)device;
  strncpy(error->text, "there is no hardware behind this", error->capacity - 1);
  return IMUNOISE_NOT_FOUND;
}
static int32_t describe(imunoise_device* device, const imunoise_device_info** info,
                        imunoise_error* error) {
  (void)device, (void)info, (void)error;
  return IMUNOISE_FAILED;
}
static int32_t read_device(imunoise_device* device, int32_t timeout_ms, imunoise_block* block,
                           imunoise_error* error) {
  (void)device, (void)timeout_ms, (void)block, (void)error;
  return IMUNOISE_FAILED;
}
static void nothing(imunoise_device* device) { (void)device; }

static imunoise_driver driver = {sizeof(imunoise_driver),
                                 IMUNOISE_DRIVER_ABI,
                                 "sound",
                                 "A driver in C",
                                 "1.0",
                                 1,
                                 1,
                                 options,
                                 streams,
                                 &open_device,
                                 &describe,
                                 &read_device,
                                 &nothing,
                                 &nothing};

/* For statements to use. */
extern const char* endless(void);
const char* endless(void) {
  static char text[100000];
  memset(text, 'x', sizeof text - 1);
  return text;
}

const imunoise_driver* imunoise_driver_entry(uint32_t host_abi, const imunoise_host* host) {
  const double nan = NAN;
  const double infinity = INFINITY;
  const imunoise_driver* table = &driver;
  (void)host_abi, (void)host, (void)nan, (void)infinity;
  SPOIL;
  return table;
}
