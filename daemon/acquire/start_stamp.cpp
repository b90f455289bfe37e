#include "daemon/acquire/start_stamp.h"

namespace imunoise::acquire {

void stamp_start(v1::ReplicateNote& note, const Clock& clock) {
  note.set_started_ns(ns(clock.now()));
  note.set_boot_id(clock.boot_id());
  note.set_started_since_boot_ns(clock.since_boot().count());
  note.set_clock_synchronised(clock.synchronised());
}

}  // namespace imunoise::acquire
