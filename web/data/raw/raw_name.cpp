#include "web/data/raw/raw_name.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "stormcellar/base/station_table.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t compact_size = 15;  // "20220317_000842"
constexpr std::array<std::string_view, 3> packed_endings = {".gz", ".bz2", ".Z"};

bool are_digits(std::string_view text) {
    return std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

std::string_view packed_ending_of(std::string_view name) {
    for (const std::string_view ending : packed_endings)
        if (name.ends_with(ending)) return ending;
    return {};
}

// Returns true if the text is "_V06" or a similar version, ".gz", both, or nothing.
bool is_bucket_ending(std::string_view ending) {
    ending.remove_suffix(packed_ending_of(ending).size());
    return ending.empty() ||
           (ending.size() == 4 && ending.starts_with("_V") && are_digits(ending.substr(2)));
}

}  // namespace

std::string raw_name(std::string_view station, UtcTime start, std::string_view file_name) {
    std::string name = std::string{station} + format_compact(start);
    if (time_of_raw_name(station, file_name)) {
        const std::string_view ending = file_name.substr(station.size() + compact_size);
        if (is_bucket_ending(ending)) return name.append(ending);
    }
    const auto known = find_station(station);
    const bool is_tdwr = known && known->kind == RadarKind::tdwr;
    name.append(is_tdwr ? "_V08" : "_V06");
    return name.append(packed_ending_of(file_name));
}

std::optional<UtcTime> time_of_raw_name(std::string_view station, std::string_view name) {
    if (!name.starts_with(station) || name.size() < station.size() + compact_size) {
        return std::nullopt;
    }
    const auto time = parse_compact(name.substr(station.size(), compact_size));
    return time ? std::optional{*time} : std::nullopt;
}

bool is_volume_name(std::string_view station, std::string_view name) {
    return name.size() == station.size() + compact_size && time_of_raw_name(station, name);
}

std::optional<UtcTime> time_in_file_name(std::string_view name) {
    constexpr std::size_t short_size = 13;  // "20220317_0008"
    for (std::size_t at = 0; at + short_size <= name.size(); ++at) {
        const char mark = name[at + 8];
        if ((mark != '_' && mark != '-') || !are_digits(name.substr(at, 8)) ||
            !are_digits(name.substr(at + 9, 4))) {
            continue;
        }
        const bool has_seconds =
            at + compact_size <= name.size() && are_digits(name.substr(at + short_size, 2));
        const std::string text = std::string{name.substr(at, 8)} + '_' +
                                 std::string{name.substr(at + 9, 4)} +
                                 (has_seconds ? std::string{name.substr(at + 13, 2)} : "00");
        if (const auto time = parse_compact(text)) return *time;
    }
    return std::nullopt;
}

}  // namespace stormcellar::web
