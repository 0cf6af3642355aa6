#include "tests/cache/small_grid.h"

#include <limits>

namespace stormcellar::testing {

grid::Grid small_grid() {
    using grid::CellStatus;
    grid::Grid made;
    made.spec.center_latitude_deg = 42.2;
    made.spec.center_longitude_deg = -75.98;
    made.spec.nx = 40;
    made.spec.ny = 24;
    for (int level = 1; level <= 18; ++level)
        made.spec.levels_m.push_back(500.0 * level);
    made.time = *parse_utc("2005-08-22T02:44:14.123Z", UtcTime{});
    made.start_time = made.time;
    made.end_time = made.time + std::chrono::minutes{5};
    made.sites = {{"KBGM", 42.19969, -75.98472, 519.1}};
    made.provenance.source_files = {"KBGM20050822_024414.gz"};
    made.provenance.stations = {"KBGM"};
    made.provenance.method = "column-linear";
    made.provenance.beam_model = "4/3 earth";
    made.provenance.averaging = "dBZ";
    made.provenance.effects = "frame: WGS84 table";
    made.provenance.predicted_error = "position 714 m";
    made.provenance.software_version = "test";
    made.provenance.vcp = 21;
    made.provenance.partial = true;
    made.provenance.notes = {"a note"};
    made.provenance.radar_troubles = {"KBGM: standby, alarm 452", "KOKX: on auxiliary power"};
    made.provenance.provisional = true;
    made.provenance.revision = 3;
    made.provenance.parts = {{"KBGM", made.time, 0x123456789ABCDEF0, {0, 16, 40, 8}},
                             {"KOKX", made.time + std::chrono::minutes{5}, 7, {16, 0, 24, 24}}};
    made.provenance.recipe = 0xFEDCBA9876543210;
    made.provenance.sweeps = {{0.5, made.start_time, 12.25, 18.5},
                              {1.5, made.start_time + std::chrono::seconds{25}, 300, 0}};
    made.provenance.audit = {
        {0.48F, 0, 60e3F, 1000, 950, 400, 1.25F, -0.0625F},
        {0.48F, 240e3F, std::numeric_limits<float>::infinity(), 7, 0, 0, 0, 0},
    };
    made.values.assign(made.spec.cell_count(), 0.0F);
    made.status.assign(made.spec.cell_count(), CellStatus::not_seen);
    for (int iy = 0; iy < made.spec.ny; ++iy) {
        for (int ix = 0; ix < made.spec.nx; ++ix) {
            for (int iz = 0; iz < made.spec.nz(); ++iz) {
                const std::size_t at = made.spec.index(ix, iy, iz);
                const bool stored_brick = ix < 16 && iy < 16 && iz < 16;
                if (stored_brick && (ix + iy + iz) % 3 == 0) {
                    made.status[at] = CellStatus::value;
                    made.values[at] = static_cast<float>(ix + iy) - 3.2F;
                } else if (stored_brick && (ix + iy + iz) % 3 == 1) {
                    made.status[at] = CellStatus::range_folded;
                } else if (ix < 32 && iz > 2) {
                    made.status[at] = CellStatus::no_echo;
                }
            }
        }
    }
    return made;
}

}  // namespace stormcellar::testing
