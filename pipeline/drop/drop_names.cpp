#include "pipeline/drop/drop_names.h"

#include <algorithm>
#include <array>

#include "stormcellar/base/station_table.h"
#include "stormcellar/level2/chunk_name.h"

namespace stormcellar::pipeline {

bool is_temporary_name(std::string_view name) {
    static constexpr std::array<std::string_view, 6> endings = {"~",     ".tmp",     ".temp",
                                                                ".part", ".partial", ".filepart"};
    if (name.empty() || name.front() == '.') return true;
    return std::any_of(endings.begin(), endings.end(),
                       [&](std::string_view ending) { return name.ends_with(ending); });
}

std::string station_of_file_name(const std::filesystem::path& path) {
    return station_in_name(path.filename().string());
}

std::string station_of_path(const std::filesystem::path& path) {
    std::filesystem::path part = path;
    for (int above = 0; above < 3; ++above, part = part.parent_path()) {
        std::string name = station_of_file_name(part);
        if (!name.empty()) return name;
    }
    return {};
}

bool is_chunk_name(const std::filesystem::path& path) {
    return level2::parse_chunk_name(path.filename().native()).has_value();
}

}  // namespace stormcellar::pipeline
