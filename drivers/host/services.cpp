#include "drivers/host/services.h"

#include <chrono>

#include "drivers/host/device.h"

namespace imunoise::drivers {
namespace {

std::int64_t now_ns() {
  using std::chrono::nanoseconds;
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<nanoseconds>(now).count();
}

void note(void* context, const char* text) {
  const auto& handler = *static_cast<const NoteHandler*>(context);
  if (handler && text != nullptr) handler(text);
}

}  // namespace

const imunoise_host& host_services() {
  static const imunoise_host kServices = {sizeof(imunoise_host), IMUNOISE_DRIVER_ABI, &now_ns,
                                          &note};
  return kServices;
}

}  // namespace imunoise::drivers
