// All devices of a type side by side.

#include "daemon/catalogue/fleet.h"

#include <gtest/gtest.h>

#include "study/report/figures/fleet_figure.h"
#include "tests/daemon/catalogue/bench_folder.h"

namespace imunoise::catalogue {
namespace {

class FleetOf : public testing::BenchFolder {
 protected:
  // N of one more device, known to this fraction.
  void add(double n, double precision = 0.01) {
    const std::string serial = std::to_string(1000 + count_);
    add_recording("of-" + serial, count_++, serial);
    add_calibration("of-" + serial, {n, n * (1.0 - precision), n * (1.0 + precision)});
  }
  Result<v1::Fleet> fleet(const FleetOptions& options = {}) const {
    auto catalogue = Catalogue::open(":memory:");
    EXPECT_TRUE(catalogue->refresh(files_, root_));
    std::vector<DeviceParameters> all;
    const auto devices = catalogue->devices();
    for (const v1::CataloguedDevice& one : *devices)
      all.emplace_back(one, *catalogue->parameters(one.id()));
    return fleet_of(all, options);
  }
  v1::FleetParameter n_of_fleet() const {
    const auto got = fleet({.parameters = {"N"}});
    EXPECT_TRUE(got) << got.error().message;
    EXPECT_EQ(got->parameters_size(), 1);
    return got->parameters(0);
  }
  int count_ = 0;
};

TEST_F(FleetOf, OrdersDevicesAndKnowsTheirQuartiles) {
  for (const double n : {1.4e-4, 1.0e-4, 1.2e-4, 1.1e-4, 1.3e-4}) add(n);
  const v1::FleetParameter n = n_of_fleet();
  ASSERT_EQ(n.devices_size(), 5);
  EXPECT_EQ(n.devices(0).device().serial(), "1001");
  EXPECT_EQ(n.devices(4).device().serial(), "1000");
  EXPECT_NEAR(n.lower_quartile(), 1.1e-4, 1e-12);
  EXPECT_NEAR(n.median(), 1.2e-4, 1e-12);
  EXPECT_NEAR(n.upper_quartile(), 1.3e-4, 1e-12);
  for (const v1::FleetDevice& one : n.devices()) EXPECT_FALSE(one.outlier());
  const auto got = fleet();
  EXPECT_EQ(got->devices(), 5U);
  EXPECT_EQ(got->type(), "simulated");
  EXPECT_EQ(got->summary(), "None of 5 devices stands out.");
  const auto drawn = report::fleet_figure(n);
  ASSERT_TRUE(drawn);
  EXPECT_EQ(drawn->panels[0].y.categories.front(), "1001");
}

TEST_F(FleetOf, FindsTheDeviceThatStandsOut) {
  for (const double n : {1.00e-4, 1.02e-4, 0.98e-4, 1.01e-4, 0.99e-4, 1.5e-4}) add(n);
  const v1::FleetParameter n = n_of_fleet();
  EXPECT_TRUE(n.devices(5).outlier());
  EXPECT_GT(n.devices(5).robust_z(), 3.5);
  EXPECT_FALSE(n.devices(4).outlier());
  EXPECT_EQ(fleet()->summary(), "These stand out: simulated:1005 (gyro_x N of WN).");
}

TEST_F(FleetOf, NoDeviceStandsOutThatIsKnownTooBadly) {
  for (const double n : {1.00e-4, 1.02e-4, 0.98e-4, 1.01e-4, 0.99e-4}) add(n);
  add(1.5e-4, 0.4);
  const v1::FleetParameter n = n_of_fleet();
  EXPECT_GT(n.devices(5).robust_z(), 3.5);
  EXPECT_FALSE(n.devices(5).outlier()) << "its interval reaches the quartiles";
}

TEST_F(FleetOf, FourDevicesAreTooFew) {
  for (const double n : {1.00e-4, 1.02e-4, 0.98e-4, 9e-4}) add(n);
  const v1::FleetParameter n = n_of_fleet();
  for (const v1::FleetDevice& one : n.devices()) EXPECT_FALSE(one.outlier());
  EXPECT_EQ(fleet()->summary().rfind("Too few devices", 0), 0U);
}

TEST_F(FleetOf, WhatHasOnlyABoundIsNotCompared) {
  for (int i = 0; i < 6; ++i) add(1e-4);
  const auto got = fleet({.parameters = {"K"}});
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->parameters(0).devices_size(), 6);
  EXPECT_EQ(got->parameters(0).seen(), 0U);
  EXPECT_FALSE(got->parameters(0).has_median());
}

TEST_F(FleetOf, NamesWhatIsNotThere) {
  EXPECT_NE(fleet().error().message.find("imunoise calibrate"), std::string::npos);
  add(1e-4);
  EXPECT_NE(fleet({.type = "xsens"}).error().message.find("simulated"), std::string::npos);
  EXPECT_FALSE(fleet({.channels = {"gyro_z"}}));
  EXPECT_FALSE(fleet({.parameters = {"Z"}}));
}

}  // namespace
}  // namespace imunoise::catalogue
