// Tests what must not change a bit of a mosaic: the order of the partials, the number of threads,
// an update instead of a merge, and the contents of bricks that are not read.
#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "stormcellar/grid/mosaic.h"
#include "tests/grid/made_partials.h"

namespace stormcellar::grid {
namespace {

TEST(MosaicBits, OrderOfArrivalAndThreadsChangeNoBit) {
    for (const Quantization& quantization : {one_byte, two_bytes}) {
        Partials partials = random_partials(quantization, 4);
        for (const Overlap overlap :
             {Overlap::mean, Overlap::nearest, Overlap::distance_weighted}) {
            MosaicOptions options;
            options.overlap = overlap;
            options.averaging = Averaging::in_z;
            options.counts = options.weights = true;
            const auto once = merge(partials.domain(), partials.all(), options);
            ASSERT_TRUE(once);
            std::mt19937 random(5);
            for (const int threads : {1, 3}) {
                options.threads = threads;
                for (int i = 0; i < 3; ++i) {
                    std::shuffle(partials.all().begin(), partials.all().end(), random);
                    const auto again = merge(partials.domain(), partials.all(), options);
                    ASSERT_TRUE(again);
                    expect_same_bits(*once, *again);
                }
            }
        }
    }
}

void expect_merges_to_the_first(Partials& partials, const MosaicOptions& options) {
    const auto made = merge(partials.domain(), partials.all(), options);
    ASSERT_TRUE(made);
    expect_same_bits(made->cells.view(), partials.all()[0].view);
}

TEST(MosaicBits, OneSiteAloneIsItsPartial) {
    for (const Quantization& quantization : {one_byte, two_bytes}) {
        const GridSpec domain = small_domain();
        Partials partials(domain);
        partials.add_random(sites[0], {0, 0, domain.nx, domain.ny}, quantization, 6);
        for (const Overlap overlap :
             {Overlap::mean, Overlap::maximum, Overlap::nearest, Overlap::distance_weighted}) {
            MosaicOptions options;
            options.overlap = overlap;
            expect_merges_to_the_first(partials, options);
        }
    }
}

TEST(MosaicBits, EqualValuesStayWhatTheyAre) {
    const GridSpec domain = small_domain();
    for (const Quantization& quantization : {one_byte, two_bytes}) {
        Partials partials(domain);
        for (const SitePosition& site : sites) {
            partials.add(site, {0, 0, domain.nx, domain.ny}, quantization,
                         [&](int ix, int iy, int iz, auto& status, float& value) {
                             status = CellStatus::value;
                             value = static_cast<float>((ix * 31 + iy * 17 + iz * 3) % 80 - 20);
                         });
        }
        for (const Averaging averaging : {Averaging::in_db, Averaging::in_z}) {
            MosaicOptions options{.averaging = averaging};
            expect_merges_to_the_first(partials, options);
        }
    }
}

TEST(MosaicBits, AnUpdateIsAFullMerge) {
    std::mt19937 random(7);
    for (const Quantization& quantization : {one_byte, two_bytes}) {
        Partials partials = random_partials(quantization, 8);
        const GridSpec& domain = partials.domain();
        MosaicOptions options;
        options.counts = options.weights = true;
        auto mosaic = merge(domain, partials.all(), options);
        ASSERT_TRUE(mosaic);
        for (unsigned round = 0; round < 12; ++round) {
            // A site has a new volume, appears, disappears, or moves its window.
            std::vector<Partial>& all = partials.all();
            std::vector<GridWindow> changed;
            const std::size_t at = random() % sites.size();
            const auto known = std::find_if(all.begin(), all.end(), [&](const Partial& partial) {
                return partial.site.icao == sites[at].icao;
            });
            if (known != all.end()) {
                changed.push_back(*window_of(domain, *known->view.spec));
                all.erase(known);
            }
            if (round % 4 != 3) {
                const GridWindow& window = windows[random() % windows.size()];
                changed.push_back(window);
                partials.add_random(sites[at], window, quantization, round + 1000);
            }
            options.threads = 1 + static_cast<int>(round % 2);
            const auto updated = update(mosaic->view(), all, changed, options);
            ASSERT_TRUE(updated);
            const auto whole = merge(domain, all, options);
            ASSERT_TRUE(whole);
            expect_same_bits(*updated, *whole);
            ASSERT_TRUE(update_in_place(*mosaic, all, changed, options));
            expect_same_bits(*mosaic, *whole);
        }
    }
}

// Each stripe, made from only the partials that touch it, must equal that part of the full merge.
TEST(MosaicBits, GrowsInStripesToTheFullMerge) {
    for (const Quantization& quantization : {one_byte, two_bytes}) {
        Partials partials = random_partials(quantization, 10);
        const GridSpec& domain = partials.domain();
        const auto whole = merge(domain, partials.all(), {});
        auto mosaic = merge(domain, {}, {});
        ASSERT_TRUE(whole && mosaic);
        if (quantization != mosaic->cells.view().quantization) {
            EXPECT_FALSE(update_in_place(*mosaic, partials.all(), {}, {}))
                << "the mosaic has other code steps";
            continue;
        }
        for (int x = 0; x < domain.nx; x += brick_edge) {
            const GridWindow stripe{x, 0, std::min(brick_edge, domain.nx - x), domain.ny};
            std::vector<Partial> touching;
            for (const Partial& partial : partials.all()) {
                const GridWindow window = *window_of(domain, *partial.view.spec);
                if (window.first_x < stripe.end_x() && x < window.end_x())
                    touching.push_back(partial);
            }
            ASSERT_TRUE(update_in_place(*mosaic, touching, {&stripe, 1}, {}));
        }
        expect_same_bits(*mosaic, *whole);
    }
}

// Damages bricks in which nothing is seen, and bricks that no changed window touches. The merge
// must read none of these bricks.
TEST(MosaicBits, ReadsOnlyWhatIsOccupiedAndTouched) {
    Partials partials = random_partials(one_byte, 9);
    const GridSpec& domain = partials.domain();
    const auto expected = merge(domain, partials.all(), {});
    ASSERT_TRUE(expected);
    std::deque<std::vector<std::byte>> spoilt;
    std::vector<Partial> all = partials.all();
    for (Partial& partial : all) {
        auto& codes = spoilt.emplace_back(partial.view.codes.begin(), partial.view.codes.end());
        for (std::size_t i = 0; i < partial.view.bricks.size(); ++i) {
            if (partial.view.bricks[i].kind == BrickKind::stored) continue;
            std::fill_n(codes.begin() + static_cast<std::ptrdiff_t>(i * brick_cells), brick_cells,
                        std::byte{200});
        }
        partial.view.codes = codes;
    }
    const auto made = merge(domain, all, {});
    ASSERT_TRUE(made);
    expect_same_bits(*expected, *made);

    // Damage all bricks outside the changed window.
    const GridWindow changed{32, 32, 16, 32};
    for (std::size_t s = 0; s < all.size(); ++s) {
        const GridWindow window = *window_of(domain, *all[s].view.spec);
        for (int bx = 0; bx < all[s].view.bricks_x; ++bx) {
            for (int by = 0; by < all[s].view.bricks_y; ++by) {
                const int x = window.first_x + bx * 16;
                const int y = window.first_y + by * 16;
                if (x >= 32 && x < 48 && y >= 32 && y < 64) continue;
                const std::size_t first = all[s].view.brick_index(bx, by, 0) * brick_cells;
                std::fill_n(spoilt[s].begin() + static_cast<std::ptrdiff_t>(first),
                            all[s].view.bricks_z * brick_cells, std::byte{200});
            }
        }
    }
    const auto updated = update(expected->view(), all, {&changed, 1}, {});
    ASSERT_TRUE(updated);
    expect_same_bits(*expected, *updated);
}

TEST(MosaicBits, NoPartialsSeeNothing) {
    const auto made = merge(small_domain(), {}, {});
    ASSERT_TRUE(made);
    for (const BrickEntry& entry : made->cells.view().bricks) {
        EXPECT_EQ(entry.kind, BrickKind::uniform);
        EXPECT_EQ(entry.uniform_status, CellStatus::not_seen);
    }
}

TEST(MosaicBits, DistancesMadeBeforeChangeNothing) {
    Partials partials = random_partials(one_byte, 10);
    const auto expected = merge(partials.domain(), partials.all(), {});
    for (Partial& partial : partials.all()) {
        partial.distance = std::make_shared<const SiteDistance>(
            partials.domain(), *window_of(partials.domain(), *partial.view.spec), partial.site);
    }
    const auto made = merge(partials.domain(), partials.all(), {});
    ASSERT_TRUE(expected && made);
    expect_same_bits(*expected, *made);
}

}  // namespace
}  // namespace stormcellar::grid
