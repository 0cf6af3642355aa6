#include "render/map/base_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "base/checksum.h"

namespace stormcellar::render {
namespace {

constexpr std::string_view magic = "SCBASMAP";
constexpr std::uint32_t version = 2;
constexpr std::size_t head_bytes = 24;

template <class Number>
Number little_endian(std::span<const std::byte> bytes, std::size_t offset) {
    Number number = 0;
    for (std::size_t i = sizeof number; i-- > 0;) {
        number = static_cast<Number>((number << 8) | std::to_integer<Number>(bytes[offset + i]));
    }
    return number;
}

// Reads numbers and bytes. A read past the end fails and returns zero, and so do all later reads.
class Reader {
  public:
    explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    [[nodiscard]] bool failed() const { return failed_; }
    [[nodiscard]] std::size_t remaining() const { return bytes_.size(); }

    std::span<const std::byte> take(std::size_t count) {
        if (count > bytes_.size()) fail_now();
        if (failed_) return {};
        const auto taken = bytes_.first(count);
        bytes_ = bytes_.subspan(count);
        return taken;
    }
    std::uint8_t byte() {
        const auto taken = take(1);
        return taken.empty() ? std::uint8_t{0} : std::to_integer<std::uint8_t>(taken[0]);
    }
    std::uint32_t number() {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 35; shift += 7) {
            const std::uint8_t part = byte();
            value |= static_cast<std::uint64_t>(part & 0x7FU) << shift;
            if (part < 0x80 && value <= 0xFFFFFFFFU) return static_cast<std::uint32_t>(value);
        }
        fail_now();
        return 0;
    }
    std::int64_t difference() {
        const std::int64_t folded = number();
        return (folded & 1) != 0 ? -(folded / 2) - 1 : folded / 2;
    }
    // Reads how many items follow. Each item must have at least `least_bytes`.
    std::size_t count(std::size_t least_bytes) {
        const std::size_t value = number();
        if (value > remaining() / least_bytes) fail_now();
        return failed_ ? 0 : value;
    }

  private:
    void fail_now() {
        failed_ = true;
        bytes_ = {};
    }

    std::span<const std::byte> bytes_;
    bool failed_ = false;
};

bool lies_on_earth(double longitude_deg, double latitude_deg) {
    return longitude_deg >= -180 && longitude_deg <= 180 && latitude_deg >= -90 &&
           latitude_deg <= 90;
}

bool read_line(Reader& reader, double unit, MapLine& line) {
    line.point_count = reader.number();
    const std::int64_t west = reader.difference();
    const std::int64_t south = reader.difference();
    const std::int64_t width = reader.number();
    const std::int64_t height = reader.number();
    line.points = reader.take(reader.number());
    line.west_deg = static_cast<double>(west) * unit;
    line.south_deg = static_cast<double>(south) * unit;
    line.east_deg = static_cast<double>(west + width) * unit;
    line.north_deg = static_cast<double>(south + height) * unit;
    // A point takes at least two bytes.
    return !reader.failed() && line.point_count >= 2 &&
           line.point_count <= line.points.size() / 2 &&
           lies_on_earth(line.west_deg, line.south_deg) &&
           lies_on_earth(line.east_deg, line.north_deg);
}

bool read_set(Reader& reader, double unit, MapSet& set) {
    const std::uint8_t kind = reader.byte();
    set.kind = static_cast<MapKind>(kind);
    set.detail = reader.byte();
    set.tolerance_m = reader.number();
    const std::size_t lines = reader.count(10);
    Reader inner(reader.take(reader.number()));
    const bool known = kind >= 1 && kind <= map_kinds.size() && set.detail < map_detail_count;
    if (reader.failed() || !known) return false;
    set.lines.resize(std::min(lines, inner.remaining()));
    for (MapLine& line : set.lines) {
        if (!read_line(inner, unit, line)) return false;
    }
    return set.lines.size() == lines && inner.remaining() == 0;
}

bool read_city(Reader& reader, double unit, MapCity& city) {
    const auto name = reader.take(reader.number());
    city.name.assign(reinterpret_cast<const char*>(name.data()), name.size());
    city.population = static_cast<int>(reader.number() & 0x7FFFFFFFU);
    city.place.latitude_deg = static_cast<double>(reader.difference()) * unit;
    city.place.longitude_deg = static_cast<double>(reader.difference()) * unit;
    return !reader.failed() && !city.name.empty() &&
           lies_on_earth(city.place.longitude_deg, city.place.latitude_deg);
}

Status check_head(std::span<const std::byte> bytes) {
    if (bytes.empty()) return fail(ErrorCode::empty, "the map has no bytes");
    if (bytes.size() < head_bytes) return fail(ErrorCode::truncated, "the map ends in its head");
    if (std::memcmp(bytes.data(), magic.data(), magic.size()) != 0) {
        return fail(ErrorCode::corrupt, "the map does not begin with SCBASMAP");
    }
    if (little_endian<std::uint32_t>(bytes, 8) != version) {
        return fail(ErrorCode::unsupported, "the map is of version {}, not {}",
                    little_endian<std::uint32_t>(bytes, 8), version);
    }
    const auto size = little_endian<std::uint64_t>(bytes, 16);
    if (size > bytes.size()) {
        return fail(ErrorCode::truncated, "the map has {} of its {} bytes", bytes.size(), size);
    }
    if (size < bytes.size()) return fail(ErrorCode::corrupt, "bytes follow the map");
    if (crc32(bytes.subspan(head_bytes)) != little_endian<std::uint32_t>(bytes, 12)) {
        return fail(ErrorCode::corrupt, "the map's checksum does not match");
    }
    return {};
}

}  // namespace

bool is_area(MapKind kind) {
    return kind == MapKind::lake || kind == MapKind::coast;
}

bool is_tile_edge(const grid::GeoPoint& from, const grid::GeoPoint& to) {
    const auto on_edge = [](double one, double other) {
        const double tiles = one / map_tile_deg;
        return std::abs(one - other) < 1e-7 && std::abs(tiles - std::nearbyint(tiles)) < 1e-7;
    };
    return on_edge(from.longitude_deg, to.longitude_deg) ||
           on_edge(from.latitude_deg, to.latitude_deg);
}

Result<BaseMap> BaseMap::read(std::span<const std::byte> bytes) {
    if (Status sound = check_head(bytes); !sound) return pass_on(sound);
    BaseMap map;
    Reader reader(bytes.subspan(head_bytes));
    const std::uint32_t units = reader.number();
    if (units == 0) return fail(ErrorCode::corrupt, "the map has no unit");
    map.degrees_per_unit_ = 1.0 / units;
    map.sets_.resize(reader.count(6));
    for (MapSet& set : map.sets_) {
        if (!read_set(reader, map.degrees_per_unit_, set)) {
            return fail(ErrorCode::corrupt, "lines of the map contradict themselves");
        }
    }
    map.cities_.resize(reader.count(5));
    for (MapCity& city : map.cities_) {
        if (!read_city(reader, map.degrees_per_unit_, city)) {
            return fail(ErrorCode::corrupt, "a city of the map contradicts itself");
        }
    }
    if (reader.failed() || reader.remaining() != 0) {
        return fail(ErrorCode::corrupt, "the map does not end where it should");
    }
    return map;
}

Result<BaseMap> BaseMap::built_in() {
    return read(built_in_map_bytes());
}

Result<std::vector<grid::GeoPoint>> BaseMap::points_of(const MapLine& line) const {
    std::vector<grid::GeoPoint> points;
    points.reserve(line.point_count);
    Reader reader(line.points);
    std::int64_t x = reader.number();
    std::int64_t y = reader.number();
    const double west = line.west_deg;
    const double south = line.south_deg;
    for (std::uint32_t i = 0; i < line.point_count; ++i) {
        if (i > 0) {
            x += reader.difference();
            y += reader.difference();
        }
        points.push_back({south + static_cast<double>(y) * degrees_per_unit_,
                          west + static_cast<double>(x) * degrees_per_unit_});
        const bool inside = x >= 0 && y >= 0 &&
                            points.back().longitude_deg < line.east_deg + 1e-9 &&
                            points.back().latitude_deg < line.north_deg + 1e-9;
        if (reader.failed() || !inside) {
            return fail(ErrorCode::corrupt, "a line of the map leaves its own box");
        }
    }
    if (reader.remaining() != 0) {
        return fail(ErrorCode::corrupt, "a line of the map has more bytes than points");
    }
    return points;
}

}  // namespace stormcellar::render
