#include "pipeline/drop/drop_names.h"

#include <gtest/gtest.h>

namespace stormcellar::pipeline {
namespace {

TEST(TemporaryNames, AreThoseOfWritersThatAreNotDone) {
    for (const char* name :
         {".KTLX20220317_000842", ".", "..", "", "KTLX.tmp", "KTLX.temp", "KTLX.part",
          "KTLX.partial", "KTLX.filepart", "KTLX~", ".stormcellar-tmp-1-2"}) {
        EXPECT_TRUE(is_temporary_name(name)) << name;
    }
}

TEST(TemporaryNames, NothingElseIsReadFromAName) {
    for (const char* name : {"KTLX20220317_000842_V06", "20201019-054806-001-S", "x", "a.gz",
                             "temp", "part", "tmpfile", "a\nb", "notes.txt"}) {
        EXPECT_FALSE(is_temporary_name(name)) << name;
    }
}

TEST(StationOfAPath, IsThatOfTheNameElseOfADirectory) {
    EXPECT_EQ(station_of_file_name("/d/KFDR/KTLX20220317_000842_V06"), "KTLX");
    EXPECT_EQ(station_of_path("/d/KFDR/KTLX20220317_000842_V06"), "KTLX");
    EXPECT_EQ(station_of_file_name("/d/KTLX/494/20220317-000842-001-S"), "");
    EXPECT_EQ(station_of_path("/d/KTLX/494/20220317-000842-001-S"), "KTLX");
    EXPECT_EQ(station_of_path("/KTLX/d/494/20220317-000842-001-S"), "")
        << "the station's directory is too far above";
    EXPECT_EQ(station_of_path("/d/QQQQ/a"), "") << "the table does not have this station";
}

}  // namespace
}  // namespace stormcellar::pipeline
