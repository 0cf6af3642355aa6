// tests/web/served_grids.h -- a cache of small grids (tests/cache/made_grids.h) and the API over
// it.
#pragma once

#include <memory>

#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/temporary_directory.h"
#include "tests/web/asked.h"
#include "web/doors/api/door.h"

namespace stormcellar::web {

// Holds the domain KBGM with grids of REF: small() at 02:44:14.123, and two others at noon and
// 12:05.
class ServedGrids {
  public:
    ServedGrids() {
        (void)store().commit("KBGM", cache::describe(small_),
                             grid::BrickGrid::from(small_, quantization()).view());
        for (const int minutes : {0, 5}) {
            (void)testing::commit_sized(store_, "KBGM",
                                        testing::noon + std::chrono::minutes{minutes});
        }
        grids_ = *Grids::open({.cache = directory_ / "cache", .most_open = 4});
        door_ = std::make_unique<ApiDoor>(
            ApiSources{.grids = grids_,
                       .catalog = {},
                       .kept = std::make_shared<KeptAnswers>(std::uint64_t{16} << 20)});
    }
    [[nodiscard]] static grid::Quantization quantization() {
        return grid::default_quantization(level2::Moment::ref);
    }
    [[nodiscard]] cache::StoreWriter& store() { return store_; }
    [[nodiscard]] Grids& grids() { return *grids_; }
    [[nodiscard]] const std::shared_ptr<Grids>& shared_grids() { return grids_; }
    [[nodiscard]] ApiDoor& door() { return *door_; }
    [[nodiscard]] const grid::Grid& small() const { return small_; }
    [[nodiscard]] Answer get(std::string_view target, Fields headers = {}) {
        return asked(*door_, target, std::move(headers));
    }

    static constexpr const char* small_path = "/api/v1/grids/KBGM/REF/2005-08-22T02:44:14.123Z";
    static constexpr const char* noon_path = "/api/v1/grids/KBGM/REF/2024-11-22T12:00:00Z";

  private:
    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", false);
    grid::Grid small_ = testing::small_grid();
    std::shared_ptr<Grids> grids_;
    std::unique_ptr<ApiDoor> door_;
};

}  // namespace stormcellar::web
