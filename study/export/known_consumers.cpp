#include "study/export/known_consumers.h"

#include <algorithm>
#include <array>

// One line a consumer: the name of its file, and of the function there that gives its descriptor.
#define IMUNOISE_CONSUMERS(CONSUMER) \
  CONSUMER(kalibr)                   \
  CONSUMER(openvins)                 \
  CONSUMER(orb_slam3)                \
  CONSUMER(basalt)                   \
  CONSUMER(gtsam)                    \
  CONSUMER(lio_sam)                  \
  CONSUMER(vins_fusion)              \
  CONSUMER(fast_lio)                 \
  CONSUMER(px4)                      \
  CONSUMER(ardupilot)                \
  CONSUMER(gazebo)                   \
  CONSUMER(airsim)                   \
  CONSUMER(matlab)                   \
  CONSUMER(kf_gins)                  \
  CONSUMER(navego)                   \
  CONSUMER(ros)                      \
  CONSUMER(autoware)                 \
  CONSUMER(isaac_sim)                \
  CONSUMER(kf_json)                  \
  CONSUMER(kf_numpy)                 \
  CONSUMER(kf_matlab)                \
  CONSUMER(kf_cpp)                   \
  CONSUMER(csv)                      \
  CONSUMER(latex)

namespace imunoise::study {

namespace consumers {
#define IMUNOISE_DECLARE(NAME) const Consumer& NAME();
IMUNOISE_CONSUMERS(IMUNOISE_DECLARE)
#undef IMUNOISE_DECLARE
}  // namespace consumers

std::span<const Consumer* const> known_consumers() {
#define IMUNOISE_LIST(NAME) &consumers::NAME(),
  static const std::array kAll{IMUNOISE_CONSUMERS(IMUNOISE_LIST)};
#undef IMUNOISE_LIST
  return kAll;
}

const Consumer* consumer_called(std::string_view name) {
  const std::span<const Consumer* const> all = known_consumers();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Consumer* one) { return one->name == name; });
  return found == all.end() ? nullptr : *found;
}

std::string consumer_names() {
  std::string out;
  for (const Consumer* const one : known_consumers())
    out += (out.empty() ? "" : ", ") + std::string(one->name);
  return out;
}

}  // namespace imunoise::study
