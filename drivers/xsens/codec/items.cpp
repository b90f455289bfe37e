#include "drivers/xsens/codec/items.h"

#include <algorithm>

namespace imunoise::drivers {
namespace {

const std::vector<XsensNumberItem>& number_items() {
  static const std::vector<XsensNumberItem> kItems = [] {
    std::vector<XsensNumberItem> out = {
        {XsensItem::kTemperature, "degC", {"temperature"}},
        {XsensItem::kQuaternion, "1", {"q0", "q1", "q2", "q3"}, true},
        {XsensItem::kRotationMatrix,
         "1",
         {"r11", "r21", "r31", "r12", "r22", "r32", "r13", "r23", "r33"},
         true},
        {XsensItem::kEulerAngles, "deg", {"roll", "pitch", "yaw"}, true},
        {XsensItem::kDeltaV, "m/s", {"delta_v_x", "delta_v_y", "delta_v_z"}},
        {XsensItem::kAcceleration, "m/s^2", {"acc_x", "acc_y", "acc_z"}},
        {XsensItem::kFreeAcceleration, "m/s^2", {"free_acc_x", "free_acc_y", "free_acc_z"}, true},
        {XsensItem::kAccelerationHr, "m/s^2", {"acc_hr_x", "acc_hr_y", "acc_hr_z"}},
        {XsensItem::kAltitude, "m", {"altitude"}},
        {XsensItem::kPositionEcef, "m", {"ecef_x", "ecef_y", "ecef_z"}},
        {XsensItem::kLatLon, "deg", {"latitude", "longitude"}},
        {XsensItem::kRateOfTurn, "rad/s", {"gyro_x", "gyro_y", "gyro_z"}},
        {XsensItem::kDeltaQ, "1", {"delta_q0", "delta_q1", "delta_q2", "delta_q3"}},
        {XsensItem::kRateOfTurnHr, "rad/s", {"gyro_hr_x", "gyro_hr_y", "gyro_hr_z"}},
        {XsensItem::kMagneticField, "a.u.", {"mag_x", "mag_y", "mag_z"}},
        {XsensItem::kVelocity, "m/s", {"velocity_x", "velocity_y", "velocity_z"}, true},
    };
    for (XsensNumberItem& item : out) item.si = si_unit(item.unit);
    return out;
  }();
  return kItems;
}

}  // namespace

const XsensNumberItem* find_number_item(std::uint16_t id) {
  const auto& items = number_items();
  const auto found = std::find_if(items.begin(), items.end(), [&](const XsensNumberItem& known) {
    return known.item == kind_of(id);
  });
  return found == items.end() ? nullptr : &*found;
}

}  // namespace imunoise::drivers
