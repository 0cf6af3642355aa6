// tests/pipeline/hailed_frame.h -- a cache with a frame of two radars that see hail differently,
// and the partials of which it was made.
#pragma once

#include <vector>

#include "pipeline/mosaic/mosaic_frame.h"
#include "tests/pipeline/invented_partials.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {

class HailedFrame {
  public:
    HailedFrame() {
        // KENX sees weaker echo on its left half, and stronger echo on its right half.
        for (const int minute : {0, 6}) {
            files_.push_back(commit(store, {.minute = minute, .column = 0, .value = 58}));
            grid::Grid other = grid_of({.station = "KENX", .minute = minute, .column = 16});
            for (int iy = 0; iy < other.spec.ny; ++iy)
                for (int ix = 0; ix < other.spec.nx; ++ix)
                    for (int iz = 0; iz < other.spec.nz(); ++iz)
                        other.values[other.spec.index(ix, iy, iz)] = iy < 16 ? 44.0F : 70.0F;
            files_.push_back(commit(store, "KENX", other));
        }
        const MosaicFrame frame = made_of({"KBGM", "KENX"});
        description = frame.description;
        (void)store.commit("north", description, frame.mosaic.cells.view());
    }
    // Makes the frame of some radars.
    [[nodiscard]] MosaicFrame made_of(const std::vector<std::string>& stations) const {
        std::vector<cache::GridFile> open;
        for (const std::filesystem::path& file : files_)
            open.push_back(*cache::GridFile::open(file));
        std::vector<PartialView> views;
        for (const cache::GridFile& file : open)
            if (std::ranges::find(stations, file.description().sites[0].icao) != stations.end())
                views.push_back({&file.description(), file.view(), &file});
        GeometryCache geometries(2);
        auto made = make_frame(small_domain().spec, views, instant, {}, geometries);
        EXPECT_TRUE(made) << made.error().message;
        return std::move(*made);
    }
    // Removes the partials of KENX.
    void forget_one() const {
        for (const std::filesystem::path& file : files_)
            if (file.native().find("north.KENX") != std::string::npos)
                std::filesystem::remove(file);
    }

    testing::TemporaryDirectory directory;
    cache::StoreWriter store =
        *cache::StoreWriter::open(real_file_system(), directory / "cache", false);
    const UtcTime instant = minute(5);
    cache::GridDescription description;  // of the frame of both

  private:
    std::vector<std::filesystem::path> files_;
};

}  // namespace stormcellar::pipeline
