#include "drivers/host/services.h"

#include <ctime>

#include "core/support/utf8.h"

namespace imunoise::drivers {
namespace {

std::int64_t read_clock(clockid_t id) {
  timespec time{};
  ::clock_gettime(id, &time);
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

void note(void* context, const char* text) {
  const auto& handlers = *static_cast<const DeviceHandlers*>(context);
  if (handlers.note && text != nullptr) handlers.note(repaired_utf8(text));
}

std::int32_t wire(void* context, const std::uint8_t* bytes, std::uint64_t count) {
  const auto& handlers = *static_cast<const DeviceHandlers*>(context);
  if (!handlers.wire) return 0;
  if (count > 0) handlers.wire({bytes, count});
  return 1;
}

void while_opening(void* context, void (*cancel)(void* argument), void* argument) {
  auto& handlers = *static_cast<DeviceHandlers*>(context);
  handlers.stopping.reset();
  if (cancel != nullptr) handlers.stopping.emplace(handlers.stop, [=] { cancel(argument); });
}

}  // namespace

std::int64_t host_time_ns() {
  static const std::int64_t kBoot = read_clock(CLOCK_REALTIME) - read_clock(CLOCK_BOOTTIME);
  return kBoot + read_clock(CLOCK_BOOTTIME);
}

const imunoise_host& host_services() {
  static const imunoise_host kServices = {
      sizeof(imunoise_host), IMUNOISE_DRIVER_ABI, &host_time_ns, &note, &wire, &while_opening};
  return kServices;
}

}  // namespace imunoise::drivers
