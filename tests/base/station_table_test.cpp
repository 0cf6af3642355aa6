#include "stormcellar/base/station_table.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace stormcellar {
namespace {

std::size_t count(RadarKind kind) {
    return static_cast<std::size_t>(std::ranges::count(all_stations(), kind, &Station::kind));
}

TEST(StationTable, IsSortedWithoutRepeats) {
    const auto out_of_order = std::ranges::adjacent_find(
        all_stations(), [](const Station& a, const Station& b) { return a.icao >= b.icao; });
    EXPECT_EQ(out_of_order, all_stations().end());
}

TEST(StationTable, EveryFieldIsFilled) {
    for (const Station& station : all_stations()) {
        EXPECT_TRUE(is_icao(station.icao)) << station.icao;
        EXPECT_FALSE(station.name.empty()) << station.icao;
        EXPECT_GE(station.state.size(), 2U) << station.icao;
        EXPECT_NE(station.latitude_deg, 0) << station.icao;
        EXPECT_NE(station.longitude_deg, 0) << station.icao;
    }
}

// The 165 WSR-88D are 159 radars in operation, four former radars (KJAN, KLIX, KRMX and LPLA), and
// two radars in Norman (KCRI and KOUN).
TEST(StationTable, HoldsTheWholeNetwork) {
    EXPECT_EQ(count(RadarKind::nexrad), 165U);
    EXPECT_EQ(count(RadarKind::tdwr), 45U);
}

// Guam is the southernmost site, Fairbanks the northernmost, and KICX the highest.
TEST(StationTable, PositionsAreInBounds) {
    for (const Station& station : all_stations()) {
        EXPECT_GE(station.latitude_deg, 13.4) << station.icao;
        EXPECT_LE(station.latitude_deg, 65.1) << station.icao;
        const bool far_east = station.longitude_deg > 126 && station.longitude_deg < 145;
        const bool american = station.longitude_deg > -166 && station.longitude_deg < -66;
        EXPECT_TRUE(far_east || american || station.icao == "LPLA") << station.icao;
        EXPECT_GE(station.antenna_altitude_m, 25) << station.icao;  // a tower near sea level
        EXPECT_LE(station.antenna_altitude_m, 3300) << station.icao;
    }
}

// The names of all TDWR begin with T. The only WSR-88D whose name begins with T is TJUA in Puerto
// Rico.
TEST(StationTable, KindsFollowNames) {
    for (const Station& station : all_stations()) {
        const bool tdwr = station.icao.front() == 'T' && station.icao != "TJUA";
        EXPECT_EQ(station.kind == RadarKind::tdwr, tdwr) << station.icao;
    }
}

// The first letters of an ICAO name give the region, so the test finds lost signs and swapped
// fields.
TEST(StationTable, NamesFollowPlaces) {
    for (const Station& station : all_stations()) {
        if (station.icao.front() == 'K') {
            EXPECT_GT(station.latitude_deg, 24) << station.icao;
            EXPECT_LT(station.latitude_deg, 49) << station.icao;
            EXPECT_GT(station.longitude_deg, -125) << station.icao;
            EXPECT_LT(station.longitude_deg, -67) << station.icao;
        }
        if (station.state == "AK") {
            EXPECT_TRUE(station.icao.starts_with("PA")) << station.icao;
        }
        if (station.state == "HI") {
            EXPECT_TRUE(station.icao.starts_with("PH")) << station.icao;
        }
    }
}

struct Reported {
    std::string_view icao;
    double latitude_deg;
    double longitude_deg;
    double antenna_altitude_m;
};

void expect_agreement(const Reported& reported, double position_tolerance_deg) {
    const auto station = find_station(reported.icao);
    ASSERT_TRUE(station) << reported.icao;
    EXPECT_NEAR(station->latitude_deg, reported.latitude_deg, position_tolerance_deg)
        << reported.icao;
    EXPECT_NEAR(station->longitude_deg, reported.longitude_deg, position_tolerance_deg)
        << reported.icao;
    EXPECT_NEAR(station->antenna_altitude_m, reported.antenna_altitude_m, 1.3) << reported.icao;
}

// Radars have reported these positions in message 31 since 2013. The altitude is the sum of site
// and tower, each rounded down to meters; for a TDWR the altitude is the site height alone.
TEST(StationTable, AgreesWithMessage31) {
    const Reported volumes[] = {
        {"KATX", 48.19461, -122.4957, 161 + 34},
        {"KCCX", 40.92305, -78.00389, 733 + 24},
        {"KCRP", 27.78402, -97.51125, 14 + 29},
        {"KDMX", 41.7312, -93.72287, 299 + 34},
        {"KFTG", 39.78664, -104.54581, 1675 + 34},
        {"KFWS", 32.5730, -97.3031, 212 + 24},
        {"KIWX", 41.35861, -85.7, 292 + 29},
        {"KLBB", 33.65414, -101.81416, 1005 + 24},
        {"KLOT", 41.60444, -88.08444, 202 + 29},
        {"KLWX", 38.9761, -77.4875, 89 + 34},
        {"KMKX", 42.9679, -88.5507, 292 + 19},
        {"KTLX", 35.33336, -97.27776, 370 + 19},
        {"TORD", 41.797, -87.858, 226},
        {"TSTL", 38.805, -90.489, 197},
    };
    for (const Reported& volume : volumes)
        expect_agreement(volume, 0.0005);
}

// These positions come from an independent source: the product description blocks of Level III
// products of 2013 to 2023. The blocks give thousandths of a degree, and feet.
TEST(StationTable, AgreesWithLevelIIIProducts) {
    constexpr double foot_m = 0.3048;
    const Reported products[] = {
        {"KBYX", 24.597, -81.703, 89 * foot_m},   {"KCAE", 33.949, -81.119, 344 * foot_m},
        {"KDGX", 32.280, -89.984, 609 * foot_m},  {"KDTX", 42.700, -83.472, 1216 * foot_m},
        {"KEAX", 38.810, -94.264, 1092 * foot_m}, {"KESX", 35.701, -114.891, 4948 * foot_m},
        {"KFFC", 33.363, -84.566, 972 * foot_m},  {"KILX", 40.150, -89.337, 730 * foot_m},
        {"KJAX", 30.485, -81.702, 159 * foot_m},  {"KLTX", 33.989, -78.429, 145 * foot_m},
        {"KMHX", 34.776, -76.876, 144 * foot_m},  {"KNKX", 32.919, -117.041, 1052 * foot_m},
        {"KSHV", 32.451, -93.841, 386 * foot_m},  {"KSRX", 35.290, -94.362, 737 * foot_m},
        {"KTBW", 27.705, -82.402, 122 * foot_m},  {"TEWR", 40.594, -74.270, 136 * foot_m},
    };
    for (const Reported& product : products)
        expect_agreement(product, 0.0015);
}

// In September 2010, two sites took their heights in meters for feet and converted them again:
// message 31 had 4 + 9 m at KDOX and 171 + 9 m at KTYX. These heights are 0.3048 times the heights
// of the table. The table's height replaces a reported height that differs by more than 30 m, so
// the differences of these two sites must be larger.
TEST(StationTable, ContradictsHeightsConvertedTwice) {
    const auto dover = find_station("KDOX");
    const auto drum = find_station("KTYX");
    ASSERT_TRUE(dover && drum);
    EXPECT_GT(dover->antenna_altitude_m - (4 + 9), 30);
    EXPECT_GT(drum->antenna_altitude_m - (171 + 9), 30);
    EXPECT_NEAR(dover->antenna_altitude_m * 0.3048, 4 + 9, 3);
    EXPECT_NEAR(drum->antenna_altitude_m * 0.3048, 171 + 9, 3);
}

TEST(StationTable, FindsEachStationItLists) {
    for (const Station& station : all_stations()) {
        const auto found = find_station(station.icao);
        ASSERT_TRUE(found) << station.icao;
        EXPECT_EQ(found->icao, station.icao);
        EXPECT_EQ(found->latitude_deg, station.latitude_deg);
    }
}

TEST(StationTable, FindsTheSitesOfBothNewOrleansRadars) {
    ASSERT_TRUE(find_station("KLIX"));
    ASSERT_TRUE(find_station("KHDC"));
    EXPECT_NE(find_station("KLIX")->longitude_deg, find_station("KHDC")->longitude_deg);
}

TEST(StationTable, MissesWhatIsNotListed) {
    using namespace std::string_view_literals;
    for (const std::string_view name :
         {""sv, "klot"sv, "Klot"sv, "KLO"sv, "KLOTT"sv, " KLOT"sv, "KLOT "sv, "LOT"sv, "AAAA"sv,
          "ZZZZ"sv, "KLOT\0"sv, "\0\0\0\0"sv, "\xff\xff\xff\xff"sv, "../K"sv}) {
        EXPECT_FALSE(find_station(name)) << name;
    }
}

TEST(IsIcao, TakesALetterAndThreeLettersOrDigits) {
    EXPECT_TRUE(is_icao("KTLX"));
    EXPECT_TRUE(is_icao("DAN1"));
    EXPECT_TRUE(is_icao("A000"));
    EXPECT_TRUE(is_icao("Z999"));
    EXPECT_TRUE(is_icao("QQQQ"));  // only the form counts
}

TEST(IsIcao, RefusesOtherLengths) {
    EXPECT_FALSE(is_icao(""));
    EXPECT_FALSE(is_icao("KTL"));
    EXPECT_FALSE(is_icao("KTLXX"));
}

// Replaces each byte of a name by every value.
TEST(IsIcao, RefusesEveryOtherByte) {
    for (std::size_t place = 0; place < 4; ++place) {
        for (int value = 0; value < 256; ++value) {
            std::string text = "KTLX";
            text[place] = static_cast<char>(value);
            const bool letter = value >= 'A' && value <= 'Z';
            const bool digit = value >= '0' && value <= '9';
            EXPECT_EQ(is_icao(text), letter || (digit && place > 0)) << place << ' ' << value;
        }
    }
}

TEST(StationTable, AFileIsNamedAfterItsStation) {
    for (const char* name :
         {"KTLX20240601_220000_V06", "KTLX_any", "ktlx.gz", "6500KTLX19910720_160529.Z",
          "Level2_KTLX_19990503_2356.ar2v", "19990503_235621_KTLX.gz", "NEXRAD_KTLX.dat",
          "L2-BZIP2_KTLX_20150908215946_494_43_I_V06_0", "copy of ktlx20240601_220000",
          "KTLX and again KTLX"}) {
        EXPECT_EQ(station_in_name(name), "KTLX") << name;
    }
    for (const char* name : {"", "20240601-220000-001-S", "storm.ar2v", "XKTLX.gz", "old-KTLXX.gz",
                             "from_KTLX_and_KFDR.tar", "..."}) {
        EXPECT_EQ(station_in_name(name), "") << name;
    }
}

}  // namespace
}  // namespace stormcellar
