// tests/grid/real_volume.h -- real volumes and their sites.
//
// A test that uses a real volume begins with STORMCELLAR_NEED_DATA().
#pragma once

#include <string>

#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/chunk_directory.h"
#include "tests/testing/data.h"

namespace stormcellar::grid {

// Decodes a file, or a folder of chunks, of the real data, such as
// "volumes/KLOT20220317_000842_V06".
[[nodiscard]] inline level2::Volume real_volume(const std::string& name) {
    return level2::decode_path(*stormcellar::testing::data_directory() / name).value().volume;
}

[[nodiscard]] inline SitePosition site_of(const level2::Volume& volume) {
    const auto antenna = level2::antenna_position(volume).value();
    return {volume.station, antenna.latitude_deg, antenna.longitude_deg, antenna.altitude_m};
}

}  // namespace stormcellar::grid
