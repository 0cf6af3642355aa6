#include "fetch/feed/chunk_key.h"

#include <charconv>
#include <utility>

#include "stormcellar/base/station_table.h"

namespace stormcellar::feed {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t compact_length = 15, dash_at = 8;
constexpr UtcTime first_time{std::chrono::sys_days{1991y / 1 / 1}};

// Returns the time in the form that names of chunks have: "20220317-000842".
std::string dashed(UtcTime time) {
    std::string text = format_compact(time);
    text[dash_at] = '-';
    return text;
}

std::optional<UtcTime> parse_dashed(std::string text) {
    if (text.size() != compact_length) return std::nullopt;
    text[dash_at] = '_';
    const auto time = parse_compact(text);
    if (!time) return std::nullopt;
    return *time;
}

}  // namespace

std::optional<int> parse_volume_number(std::string_view text) {
    int number = 0;
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, number);
    const bool is_number = error == std::errc{} && stopped == end && !text.starts_with('0');
    if (!is_number || number < 1 || number > last_volume) return std::nullopt;
    return number;
}

int volume_number_after(int number, int steps) {
    return (number - 1 + steps) % last_volume + 1;
}

std::string directory_of(std::string_view station, int number) {
    return fmt::format("{}/{}/", station, number);
}

std::string prefix_of(std::string_view station, const VolumeId& volume) {
    return directory_of(station, volume.number) + dashed(volume.time);
}

std::optional<ChunkKey> parse_chunk_key(std::string_view key, UtcTime now) {
    const std::size_t first = key.find('/');
    const std::size_t second = first == key.npos ? first : key.find('/', first + 1);
    if (second == key.npos) return std::nullopt;
    const std::string_view station = key.substr(0, first);
    const auto number = parse_volume_number(key.substr(first + 1, second - first - 1));
    const std::string_view name = key.substr(second + 1);
    const auto chunk = level2::parse_chunk_name(name);
    // Write the key again and compare, because names of LDM may have other forms, which keys may
    // not have.
    if (!is_icao(station) || !number || !chunk || level2::to_string(*chunk) != name)
        return std::nullopt;
    const auto time = parse_dashed(chunk->volume);
    if (!time || *time < first_time || *time > now + tolerated_clock_error) return std::nullopt;
    return ChunkKey{std::string{station}, {*time, *number}, chunk->number, chunk->kind};
}

std::string to_string(const ChunkKey& key) {
    return fmt::format(
        "{}{}", directory_of(key.station, key.volume.number),
        level2::to_string(level2::ChunkName{dashed(key.volume.time), key.number, key.kind}));
}

}  // namespace stormcellar::feed
