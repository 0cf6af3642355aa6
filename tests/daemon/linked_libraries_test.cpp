// Tests that the daemon links only the libraries that ingest needs: no renderer, video or netCDF.
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/testing/program.h"

namespace stormcellar::daemon {
namespace {

TEST(LinkedLibraries, AreOnlyWhatIngestNeeds) {
    const auto ldd = testing::run_program("/usr/bin/ldd", {STORMCELLARD});
    ASSERT_EQ(ldd.status, 0) << ldd.err;
    ASSERT_NE(ldd.out.find("libsqlite3"), std::string::npos) << "ldd printed an unexpected list";
    std::istringstream lines(ldd.out);
    for (std::string line; std::getline(lines, line);) {
        for (const char* unwanted :
             {"libavcodec", "libavformat", "libavutil", "libavfilter", "libswscale", "libcairo",
              "libfreetype", "libnetcdf", "libhdf5", "libpng", "libwebp", "libX11", "libcurl"}) {
            EXPECT_EQ(line.find(unwanted), std::string::npos) << line;
        }
    }
}

}  // namespace
}  // namespace stormcellar::daemon
