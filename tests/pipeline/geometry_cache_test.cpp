#include "pipeline/keep/geometry_cache.h"

#include <gtest/gtest.h>

#include "tests/pipeline/small_domain.h"

namespace stormcellar::pipeline {
namespace {

const grid::SitePosition near_site{"KBGM", 42.2, -75.98, 500};
const grid::SitePosition far_site{"PGUA", 13.45, 144.81, 110};

// The cache must not confuse a window that it does not hold with a site out of reach, which has no
// window. 2026-11-29: the cache confused the two cases, so mosaics left out all sites.
TEST(GeometryCache, AMissingWindowIsNotAnEmptyOne) {
    const grid::GridSpec domain = small_domain().spec;
    const auto window = grid::site_window(domain, near_site, grid::site_reach_m);
    ASSERT_TRUE(window);
    GeometryCache cache(1);
    for (const char* turn : {"made", "kept"}) {
        EXPECT_EQ(cache.window(domain, near_site, grid::site_reach_m), window) << turn;
        EXPECT_EQ(cache.window(domain, far_site, grid::site_reach_m), std::nullopt) << turn;
    }
}

TEST(GeometryCache, VolumesOfOneSiteOnOneGridShareIt) {
    const grid::GridSpec spec = small_domain().spec;
    const grid::GridWindow window{0, 0, 32, 32};
    grid::SitePosition renamed = near_site;
    renamed.icao = "KXXX";
    GeometryCache cache(1);
    EXPECT_EQ(cache.distance(spec, window, near_site), cache.distance(spec, window, renamed));
    EXPECT_NE(cache.distance(spec, window, near_site),
              cache.distance(spec, {0, 0, 48, 32}, near_site));
    EXPECT_EQ(cache.places(near_site, spec), cache.places(renamed, spec));
    const auto first = cache.get(near_site, spec);
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_EQ(*cache.get(renamed, spec), *first);
    ASSERT_TRUE(cache.get(near_site, spec, grid::FrameKind::sphere));
    EXPECT_NE(*cache.get(near_site, spec), *first) << "the cache should keep only one geometry";
}

TEST(GeometryCache, AnErrorIsNotKept) {
    grid::GridSpec spec = small_domain().spec;
    spec.nx = 0;
    GeometryCache cache(1);
    EXPECT_FALSE(cache.get(near_site, spec));
    EXPECT_FALSE(cache.get(near_site, spec));
}

}  // namespace
}  // namespace stormcellar::pipeline
