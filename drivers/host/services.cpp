#include "drivers/host/services.h"

#include <chrono>

#include "core/support/utf8.h"

namespace imunoise::drivers {
namespace {

std::int64_t now_ns() {
  using std::chrono::nanoseconds;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<nanoseconds>(now).count();
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

const imunoise_host& host_services() {
  static const imunoise_host kServices = {
      sizeof(imunoise_host), IMUNOISE_DRIVER_ABI, &now_ns, &note, &wire, &while_opening};
  return kServices;
}

}  // namespace imunoise::drivers
