/* A driver that lacks a library. */
#include "drivers/driver.h"
extern const imunoise_driver* nobody_has_this(void);
const imunoise_driver* imunoise_driver_entry(uint32_t host_abi, const imunoise_host* host) {
  (void)host_abi, (void)host;
  return nobody_has_this();
}
