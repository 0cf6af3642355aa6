#include "level2/foreign/quantity_names.h"

#include <gtest/gtest.h>

namespace stormcellar::level2 {
namespace {

VolumeBlock at(float latitude_deg, float longitude_deg) {
    VolumeBlock block;
    block.latitude_deg = latitude_deg;
    block.longitude_deg = longitude_deg;
    return block;
}

TEST(QuantityNames, KnowsNamesOfSeveralFormats) {
    EXPECT_EQ(quantity_named("DBZH")->moment, Moment::ref);
    EXPECT_EQ(quantity_named("velocity")->moment, Moment::vel);
    EXPECT_EQ(quantity_named("WRAD")->moment, Moment::sw);
    EXPECT_EQ(quantity_named("RhoHV")->moment, Moment::rho);
    EXPECT_FALSE(quantity_named("SQIH"));
    EXPECT_LT(quantity_named("DBZH")->rank, quantity_named("TH")->rank);
    EXPECT_EQ(quantity_of_standard_name("differential_phase_hv")->moment, Moment::phi);
    EXPECT_FALSE(quantity_of_standard_name(""));
}

TEST(QuantityNames, MakesStationsOfFourLetters) {
    const VolumeBlock sweden = at(67.8F, 20.2F);
    EXPECT_EQ(station_of("NOD:sekrn,WMO:02032,PLC:Kiruna", sweden), "SKRN");
    EXPECT_EQ(station_of("WMO:02032,RAD:SE41,NOD:sekrn", sweden), "SKRN");
    EXPECT_EQ(station_of("WMO:02032,RAD:SE41", sweden), "SE41");
    EXPECT_EQ(station_of("WMO:02032", sweden), "X032");
    EXPECT_EQ(station_of("CHIVO", sweden), "CHIV");
    EXPECT_EQ(station_of("xsapr-sgp", sweden), "XSAP");
    EXPECT_EQ(station_of("s-pol", sweden), "SPOL");
    EXPECT_EQ(station_of("X1", sweden), "X1XX");
    EXPECT_EQ(station_of("", sweden), "");
}

// Else the station table would move the radar to Oklahoma.
TEST(QuantityNames, TakesNoStationOfTheTable) {
    EXPECT_EQ(station_of("KTLX", at(35.33F, -97.28F)), "KTLX");
    const std::string elsewhere = station_of("KTLX", at(50, 8));
    EXPECT_EQ(elsewhere.substr(0, 2), "KT");
    EXPECT_NE(elsewhere, "KTLX");
    EXPECT_EQ(elsewhere, station_of("KTLX", at(50, 8)));
}

}  // namespace
}  // namespace stormcellar::level2
