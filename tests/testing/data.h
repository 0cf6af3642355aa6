// tests/testing/data.h -- finds the real volumes.
#pragma once

#include <filesystem>
#include <optional>

namespace stormcellar::testing {

// Returns $STORMCELLAR_DATA, else ../shared/data beside the source tree; none if that directory
// does not exist.
[[nodiscard]] std::optional<std::filesystem::path> data_directory();

// Returns the path of a file below data_directory(), which must exist.
[[nodiscard]] std::filesystem::path real_file(const std::filesystem::path& name);

[[nodiscard]] std::filesystem::path source_directory();

}  // namespace stormcellar::testing

// Skips the running test with a message if the real volumes are not available.
#define STORMCELLAR_NEED_DATA()                    \
    if (!::stormcellar::testing::data_directory()) \
    GTEST_SKIP() << "no real volumes: set STORMCELLAR_DATA or put them at ../shared/data"
