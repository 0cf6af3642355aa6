// tests/testing/data.h -- where the real volumes are.
#pragma once

#include <filesystem>
#include <optional>

namespace stormcellar::testing {

// $STORMCELLAR_DATA, else ../shared/data beside the source tree; none when it is not there.
[[nodiscard]] std::optional<std::filesystem::path> data_directory();

// The root of the source tree.
[[nodiscard]] std::filesystem::path source_directory();

}  // namespace stormcellar::testing

// Skips the running test, and says so, when the real volumes are not at hand.
#define STORMCELLAR_NEED_DATA()                    \
    if (!::stormcellar::testing::data_directory()) \
    GTEST_SKIP() << "no real volumes: set STORMCELLAR_DATA or put them at ../shared/data"
