#include "study/export/consumer.h"

namespace imunoise::study::consumers {

const Consumer& isaac_sim() {
  static const Consumer kConsumer{
      .name = "isaac-sim",
      .title = "Isaac Sim",
      .file = "",
      .holds = "nothing",
      .remark =
          "its IMU sensor has no noise fields; add noise to its output yourself, for example "
          "with imunoise simulate",
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
