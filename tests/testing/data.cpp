#include "tests/testing/data.h"

#include <cstdlib>

namespace stormcellar::testing {

std::filesystem::path source_directory() {
    return STORMCELLAR_SOURCE_DIRECTORY;
}

std::optional<std::filesystem::path> data_directory() {
    const char* configured = std::getenv("STORMCELLAR_DATA");
    const std::filesystem::path directory =
        configured != nullptr ? std::filesystem::path{configured}
                              : source_directory().parent_path() / "shared" / "data";
    if (!std::filesystem::is_directory(directory / "golden")) return std::nullopt;
    return directory;
}

std::filesystem::path real_file(const std::filesystem::path& name) {
    return data_directory().value() / name;
}

}  // namespace stormcellar::testing
