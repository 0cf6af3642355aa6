// tests/export/small_volume.h -- volumes of a few gates, made by hand.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::netcdf {

// The codes of one radial. If there are no codes, the radial lacks the moment.
using Row = std::vector<std::uint16_t>;

// Makes a moment that is packed like REF in message 31: gates of 250 m from 2125 m, 8 bits, scale
// 2, offset 66.
inline level2::SweepMoment small_moment(level2::Moment name, const std::vector<Row>& rows) {
    level2::SweepMoment made;
    made.moment = name;
    made.first_gate_m = 2125;
    made.gate_spacing_m = 250;
    made.scale = 2;
    made.offset = 66;
    for (const Row& row : rows)
        made.gate_stride = std::max(made.gate_stride, static_cast<std::int32_t>(row.size()));
    for (const Row& row : rows) {
        made.gate_counts.push_back(static_cast<std::uint16_t>(row.size()));
        for (std::int32_t gate = 0; gate < made.gate_stride; ++gate) {
            const auto at = static_cast<std::size_t>(gate);
            made.codes8.push_back(static_cast<std::uint8_t>(at < row.size() ? row[at] : 77));
        }
    }
    return made;
}

// Makes the moment of small_moment() with codes of 16 bits.
inline level2::SweepMoment wide_moment(level2::Moment name, const std::vector<Row>& rows) {
    level2::SweepMoment made = small_moment(name, rows);
    made.word_size_bits = 16;
    made.codes16.assign(made.codes8.size(), 77);
    made.codes8.clear();
    for (std::size_t radial = 0; radial < rows.size(); ++radial) {
        std::copy(rows[radial].begin(), rows[radial].end(),
                  made.codes16.begin() + static_cast<std::ptrdiff_t>(radial) * made.gate_stride);
    }
    return made;
}

// Makes a radial for each row of the moments. Radials are a tenth of a second and a degree apart.
inline level2::Sweep small_sweep(int number, std::vector<level2::SweepMoment> moments) {
    level2::Sweep made;
    made.elevation_number = number;
    made.vcp_elevation_deg = static_cast<float>(number) / 2;
    made.azimuth_spacing_deg = 1;
    for (std::size_t i = 0; i < moments.front().gate_counts.size(); ++i) {
        level2::Radial& radial = made.radials.emplace_back();
        radial.time =
            time_from_nexrad(19069, 522'596 + 10'000 * static_cast<std::uint32_t>(number) +
                                        100 * static_cast<std::uint32_t>(i));
        radial.azimuth_deg = static_cast<float>(i) + 0.5F;
        radial.elevation_deg = static_cast<float>(number) / 2 + static_cast<float>(i) / 16;
        radial.azimuth_number = static_cast<std::uint16_t>(i + 1);
    }
    made.moments = std::move(moments);
    return made;
}

inline level2::Volume small_volume(std::vector<level2::Sweep> sweeps) {
    level2::Volume made;
    made.station = "KTLX";
    made.header = level2::VolumeHeader{"AR2V0006.116", 19069, 522'000, "KTLX"};
    made.vcp = 212;
    made.sweeps = std::move(sweeps);
    return made;
}

}  // namespace stormcellar::netcdf
