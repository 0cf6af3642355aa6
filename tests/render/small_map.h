// tests/render/small_map.h -- encodes base maps of a few lines for tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "base/checksum.h"
#include "render/map/base_map.h"

namespace stormcellar::render {

class SmallMap {
  public:
    static constexpr double units = 1e4;

    SmallMap& set(MapKind kind, int detail, std::uint32_t tolerance_m,
                  const std::vector<std::vector<grid::GeoPoint>>& lines) {
        Bytes body;
        for (const auto& line : lines)
            put_line(body, line);
        sets_.push_back(static_cast<std::uint8_t>(kind));
        sets_.push_back(static_cast<std::uint8_t>(detail));
        number(sets_, tolerance_m);
        number(sets_, lines.size());
        number(sets_, body.size());
        sets_.insert(sets_.end(), body.begin(), body.end());
        ++set_count_;
        return *this;
    }

    SmallMap& city(const std::string& name, std::uint64_t population, grid::GeoPoint place) {
        number(cities_, name.size());
        cities_.insert(cities_.end(), name.begin(), name.end());
        number(cities_, population);
        difference(cities_, unit(place.latitude_deg));
        difference(cities_, unit(place.longitude_deg));
        ++city_count_;
        return *this;
    }

    [[nodiscard]] std::vector<std::byte> bytes() const {
        Bytes payload;
        number(payload, static_cast<std::uint64_t>(units));
        number(payload, set_count_);
        payload.insert(payload.end(), sets_.begin(), sets_.end());
        number(payload, city_count_);
        payload.insert(payload.end(), cities_.begin(), cities_.end());
        return with_head(payload);
    }

    // Returns any payload with a matching head and checksum.
    static std::vector<std::byte> with_head(const std::vector<std::uint8_t>& payload) {
        std::vector<std::byte> all(24);
        std::memcpy(all.data(), "SCBASMAP", 8);
        all[8] = std::byte{2};
        const std::size_t size = 24 + payload.size();
        for (unsigned i = 0; i < 4; ++i)
            all[16 + i] = static_cast<std::byte>(size >> (8 * i));
        for (const std::uint8_t b : payload)
            all.push_back(std::byte{b});
        const std::uint32_t sum = crc32(std::span(all).subspan(24));
        for (unsigned i = 0; i < 4; ++i)
            all[12 + i] = static_cast<std::byte>(sum >> (8 * i));
        return all;
    }

  private:
    using Bytes = std::vector<std::uint8_t>;

    static std::int64_t unit(double degrees) { return std::llround(degrees * units); }
    static void number(Bytes& bytes, std::uint64_t value) {
        for (; value >= 128; value >>= 7)
            bytes.push_back(static_cast<std::uint8_t>((value & 127) | 128));
        bytes.push_back(static_cast<std::uint8_t>(value));
    }
    static void difference(Bytes& bytes, std::int64_t value) {
        number(bytes, static_cast<std::uint64_t>(value >= 0 ? 2 * value : -2 * value - 1));
    }
    static void put_line(Bytes& bytes, const std::vector<grid::GeoPoint>& line) {
        std::int64_t west = unit(line[0].longitude_deg);
        std::int64_t south = unit(line[0].latitude_deg);
        std::int64_t east = west;
        std::int64_t north = south;
        for (const auto& p : line) {
            west = std::min(west, unit(p.longitude_deg));
            east = std::max(east, unit(p.longitude_deg));
            south = std::min(south, unit(p.latitude_deg));
            north = std::max(north, unit(p.latitude_deg));
        }
        Bytes points;
        number(points, static_cast<std::uint64_t>(unit(line[0].longitude_deg) - west));
        number(points, static_cast<std::uint64_t>(unit(line[0].latitude_deg) - south));
        for (std::size_t i = 1; i < line.size(); ++i) {
            difference(points, unit(line[i].longitude_deg) - unit(line[i - 1].longitude_deg));
            difference(points, unit(line[i].latitude_deg) - unit(line[i - 1].latitude_deg));
        }
        number(bytes, line.size());
        difference(bytes, west);
        difference(bytes, south);
        number(bytes, static_cast<std::uint64_t>(east - west));
        number(bytes, static_cast<std::uint64_t>(north - south));
        number(bytes, points.size());
        bytes.insert(bytes.end(), points.begin(), points.end());
    }

    Bytes sets_, cities_;
    std::uint64_t set_count_ = 0, city_count_ = 0;
};

}  // namespace stormcellar::render
