// tests/web/served_storms.h -- a cache with grids of a moving storm, and the answers from them.
#pragma once

#include <memory>
#include <string>

#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/temporary_directory.h"
#include "tests/web/asked.h"
#include "web/doors/api/door.h"
#include "web/doors/storms/placefiles.h"

namespace stormcellar::web {

// Returns a grid of 120 x 120 columns of 1 km about KTLX. A storm of 58 dBZ and 8 km is
// `x_km` east of the center. Its top is above the grid's highest level, 10 km.
[[nodiscard]] inline grid::Grid storm_grid(UtcTime time, double x_km) {
    grid::Grid made;
    made.spec.center_latitude_deg = 35.333;
    made.spec.center_longitude_deg = -97.278;
    made.spec.nx = made.spec.ny = 120;
    for (int level = 1; level <= 20; ++level)
        made.spec.levels_m.push_back(500.0 * level);
    made.time = made.start_time = made.end_time = time;
    made.sites = {{"KTLX", 35.333, -97.278, 384}};
    made.provenance.stations = {"KTLX"};
    made.values.assign(made.spec.cell_count(), 0.0F);
    made.status.assign(made.spec.cell_count(), grid::CellStatus::no_echo);
    for (int iy = 0; iy < made.spec.ny; ++iy) {
        for (int ix = 0; ix < made.spec.nx; ++ix) {
            const double x = made.spec.x_m(ix) / 1000 - x_km, y = made.spec.y_m(iy) / 1000;
            const double dbz = 58 - 0.35 * (x * x + y * y);
            for (int level = 0; level < made.spec.nz() && dbz > 0; ++level) {
                const std::size_t at = made.spec.index(ix, iy, level);
                made.status[at] = grid::CellStatus::value;
                made.values[at] = static_cast<float>(dbz);
            }
        }
    }
    return made;
}

class ServedStorms {
  public:
    static constexpr double storm_mps = 15;  // to the east

    // Adds the grid of the storm `minutes` after noon.
    void add(const std::string& domain, int minutes, double from_km = -20) {
        const UtcTime time = testing::noon + std::chrono::minutes{minutes};
        add(domain, storm_grid(time, from_km + storm_mps * 0.06 * minutes));
    }
    void add(const std::string& domain, const grid::Grid& made) {
        const auto bricks = grid::BrickGrid::from(made, grid::default_quantization(made.moment));
        (void)store_.commit(domain, cache::describe(made), bricks.view());
    }
    // Adds six grids, 25 minutes in all.
    void add_half_hour(const std::string& domain) {
        for (int minutes = 0; minutes <= 25; minutes += 5)
            add(domain, minutes);
    }
    [[nodiscard]] cache::StoreWriter& store() { return store_; }
    [[nodiscard]] const std::shared_ptr<Grids>& grids() const { return grids_; }
    [[nodiscard]] const std::shared_ptr<StormScans>& scans() const { return scans_; }
    [[nodiscard]] ApiDoor& api() { return api_; }
    [[nodiscard]] PlacefilesDoor& placefiles() { return placefiles_; }

  private:
    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", false);
    std::shared_ptr<Grids> grids_ = *Grids::open({.cache = directory_ / "cache"});
    std::shared_ptr<KeptAnswers> kept_ = std::make_shared<KeptAnswers>(std::uint64_t{16} << 20);
    std::shared_ptr<StormScans> scans_ = std::make_shared<StormScans>(grids_);
    std::shared_ptr<const StormAnswers> answers_ =
        std::make_shared<const StormAnswers>(scans_, kept_);
    ApiDoor api_{ApiSources{.grids = grids_, .catalog = {}, .kept = kept_, .storms = answers_}};
    PlacefilesDoor placefiles_{answers_};
};

}  // namespace stormcellar::web
