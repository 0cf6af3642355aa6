#include "pipeline/drop_names.h"

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

}  // namespace
}  // namespace stormcellar::pipeline
