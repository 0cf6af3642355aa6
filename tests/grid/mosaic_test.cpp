// Tests the rules of merging sites, by comparing cells with the slow oracle (slow_mosaic.h) and
// with results computed by hand. mosaic_bits_test.cpp tests what must be the same to the bit.
#include "stormcellar/grid/mosaic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "stormcellar/grid/beam_geometry.h"
#include "tests/grid/made_partials.h"
#include "tests/grid/slow_mosaic.h"
#include "tests/grid/square_spec.h"

namespace stormcellar::grid {
namespace {

using level2::Moment;

// Counts the compared cells, so that a test can check that enough cells were compared.
struct Compared {
    std::array<int, 4> states{};
    int close = 0;
};

Compared expect_as_the_oracle(const GridSpec& domain, std::span<const Partial> partials,
                              MosaicOptions options) {
    options.counts = options.weights = true;
    const auto mosaic = merge(domain, partials, options);
    EXPECT_TRUE(mosaic);
    Compared compared;
    if (!mosaic) return compared;
    const MosaicView made = mosaic->view();
    const std::vector<SlowCell> expected = slow_mosaic(domain, partials, options);
    const auto step = static_cast<long double>(made.cells.quantization.step);
    const auto least = static_cast<long double>(made.cells.quantization.first_value);
    int wrong = 0;
    for (int iy = 0; iy < domain.ny; ++iy) {
        for (int ix = 0; ix < domain.nx; ++ix) {
            for (int iz = 0; iz < domain.nz(); ++iz) {
                const SlowCell& cell = expected[domain.index(ix, iy, iz)];
                const CellStatus status = made.cells.status(ix, iy, iz);
                const bool seen = cell.count > 0;
                bool good = made.counts->status(ix, iy, iz) ==
                            (seen ? CellStatus::value : CellStatus::not_seen);
                good = good && made.weights->status(ix, iy, iz) ==
                                   (seen ? CellStatus::value : CellStatus::not_seen);
                if (seen && good) {
                    good = made.counts->value(ix, iy, iz) == static_cast<float>(cell.count) &&
                           std::abs(made.weights->value(ix, iy, iz) - cell.weight) < 0x1.01p-11L;
                }
                if (cell.is_close) {
                    ++compared.close;
                } else {
                    ++compared.states[static_cast<std::size_t>(cell.status)];
                    good = good && status == cell.status;
                    if (good && status == CellStatus::value) {
                        const long double off =
                            made.cells.value(ix, iy, iz) - std::max(cell.value, least);
                        good = std::abs(off) <= 0.51L * step;
                    }
                }
                if (!good && ++wrong < 5) {
                    ADD_FAILURE() << "cell " << ix << ", " << iy << ", " << iz << ": "
                                  << cell_status_name(status) << " " << made.cells.value(ix, iy, iz)
                                  << ", expected " << cell_status_name(cell.status) << " "
                                  << static_cast<double>(cell.value) << " of " << cell.count;
                }
            }
        }
    }
    EXPECT_EQ(wrong, 0);
    return compared;
}

TEST(Mosaic, EveryRuleIsThatOfTheOracle) {
    for (const Quantization& quantization : {one_byte, two_bytes}) {
        Partials partials = random_partials(quantization);
        for (const Overlap overlap :
             {Overlap::mean, Overlap::maximum, Overlap::nearest, Overlap::distance_weighted}) {
            for (const Averaging averaging : {Averaging::in_db, Averaging::in_z}) {
                MosaicOptions options{.overlap = overlap, .averaging = averaging};
                SCOPED_TRACE(fmt::format("{} bytes, {}, {}", quantization.code_bytes,
                                         overlap_name(overlap),
                                         averaging == Averaging::in_z ? "Z" : "dB"));
                const Compared compared =
                    expect_as_the_oracle(partials.domain(), partials.all(), options);
                for (const int count : compared.states)
                    EXPECT_GT(count, 1000);
                EXPECT_LT(compared.close, 100);
            }
        }
    }
}

TEST(Mosaic, OtherMomentsTakeNoDetectionLimit) {
    Partials partials = random_partials(one_byte, 2);
    for (const Moment moment : {Moment::zdr, Moment::rho, Moment::sw}) {
        MosaicOptions options{.moment = moment};
        expect_as_the_oracle(partials.domain(), partials.all(), options);
    }
    for (const Moment moment : {Moment::vel, Moment::phi}) {
        MosaicOptions options{.moment = moment, .overlap = default_overlap(moment)};
        expect_as_the_oracle(partials.domain(), partials.all(), options);
    }
}

TEST(Mosaic, ShortAndLongWeightsLoseNoSite) {
    Partials partials = random_partials(one_byte, 3);
    for (const double length_m : {1000.0, 20e3, 60e3, 1e7}) {
        MosaicOptions options{.length_m = length_m};
        SCOPED_TRACE(length_m);
        expect_as_the_oracle(partials.domain(), partials.all(), options);
    }
}

// Uses two sites at one place, whose weights are therefore equal, and computes every pair of states
// by hand.
TEST(Mosaic, EveryPairOfStatesMeetsItsRule) {
    GridSpec domain = square_spec(41, -75, 16);
    domain.levels_m = {1000};
    enum State { unseen, nothing, folded, weak, strong };
    const auto put = [](int state, auto& status, float& value) {
        status = static_cast<CellStatus>(std::min(state, 3));
        value = state == weak ? 10.0F : 40.0F;
    };
    Partials partials(domain);
    // This site is at the same place, with another name.
    partials.add({"KAAA", 41, -75, 0}, {0, 0, 16, 16}, one_byte,
                 [&](int ix, int, int, auto& status, float& value) { put(ix % 5, status, value); });
    partials.add({"KBBB", 41, -75, 0}, {0, 0, 16, 16}, one_byte,
                 [&](int, int iy, int, auto& status, float& value) { put(iy % 5, status, value); });
    const auto state_of = [&](Overlap overlap, Moment moment, int a, int b) -> double {
        MosaicOptions options{.moment = moment, .overlap = overlap};
        const auto made = merge(domain, partials.all(), options);
        const BrickView view = made->cells.view();
        const CellStatus status = view.status(a, b, 0);
        // States become -100, -101 and -102, which are not values.
        if (status != CellStatus::value) return -100 - static_cast<int>(status);
        return static_cast<double>(view.value(a, b, 0));
    };
    constexpr double not_seen = -100, no_echo = -101, range_folded = -102;
    for (const Overlap overlap :
         {Overlap::mean, Overlap::maximum, Overlap::nearest, Overlap::distance_weighted}) {
        SCOPED_TRACE(overlap_name(overlap));
        for (const auto& [alone, is] : {std::pair<int, double>{unseen, not_seen},
                                        {nothing, no_echo},
                                        {folded, range_folded},
                                        {weak, 10},
                                        {strong, 40}}) {
            EXPECT_EQ(state_of(overlap, Moment::zdr, alone, unseen), is);
            EXPECT_EQ(state_of(overlap, Moment::zdr, unseen, alone), is);
            EXPECT_EQ(state_of(overlap, Moment::zdr, alone, alone), is);
        }
    }
    for (const Overlap overlap : {Overlap::mean, Overlap::distance_weighted}) {
        EXPECT_EQ(state_of(overlap, Moment::zdr, weak, strong), 25);
        EXPECT_EQ(state_of(overlap, Moment::zdr, weak, nothing), 10) << "v = n gives a value";
        EXPECT_EQ(state_of(overlap, Moment::zdr, folded, strong), 40) << "f = v gives a value";
        EXPECT_EQ(state_of(overlap, Moment::zdr, folded, nothing), no_echo)
            << "f = n gives no echo";
        // The detection limit is -41.5 dBZ at 1 km; the radar is some 15 km away and 1 km below.
        const double arc_km = std::hypot(domain.x_m(strong), domain.y_m(nothing)) / 1000;
        const double limit = -41.5 + 20 * std::log10(std::hypot(arc_km, 1.0));
        EXPECT_NEAR(state_of(overlap, Moment::ref, strong, nothing), (40 + limit) / 2, 0.2551);
    }
    EXPECT_EQ(state_of(Overlap::maximum, Moment::ref, weak, strong), 40);
    EXPECT_EQ(state_of(Overlap::maximum, Moment::ref, nothing, weak), 10);
    EXPECT_EQ(state_of(Overlap::maximum, Moment::ref, folded, weak), 10);
    EXPECT_EQ(state_of(Overlap::maximum, Moment::ref, folded, nothing), no_echo);
    // If two sites are equally near, the first by name counts.
    EXPECT_EQ(state_of(Overlap::nearest, Moment::vel, weak, strong), 10);
    EXPECT_EQ(state_of(Overlap::nearest, Moment::vel, strong, weak), 40);
    EXPECT_EQ(state_of(Overlap::nearest, Moment::vel, folded, weak), range_folded);
    EXPECT_EQ(state_of(Overlap::nearest, Moment::vel, nothing, weak), no_echo);
}

TEST(Mosaic, OfRotationIsTheLargestOfAnySite) {
    GridSpec domain = square_spec(41, -75, 16);
    domain.levels_m = {1000};
    enum State { unseen, nothing, folded, unsure, weak, strong };
    const auto put = [](int state, auto& status, float& value) {
        constexpr CellStatus of[] = {CellStatus::not_seen,     CellStatus::no_echo,
                                     CellStatus::range_folded, CellStatus::ambiguous,
                                     CellStatus::value,        CellStatus::value};
        status = of[state];
        value = state == weak ? -12.0F : 20.0F;
    };
    const Quantization codes = default_quantization(Moment::azsh);
    Partials partials(domain);
    partials.add({"KAAA", 41, -75, 0}, {0, 0, 16, 16}, codes,
                 [&](int x, int, int, auto& status, float& value) { put(x % 6, status, value); });
    partials.add({"KBBB", 41, -75, 0}, {0, 0, 16, 16}, codes,
                 [&](int, int y, int, auto& status, float& value) { put(y % 6, status, value); });
    MosaicOptions options{.moment = Moment::azsh, .overlap = default_overlap(Moment::azsh)};
    EXPECT_EQ(options.overlap, Overlap::maximum);
    const auto made = merge(domain, partials.all(), options);
    ASSERT_TRUE(made) << made.error().message;
    const auto view = made->cells.view();
    EXPECT_EQ(view.value(weak, strong, 0), 20);
    EXPECT_EQ(view.value(weak, weak, 0), -12);
    for (const int other : {unseen, nothing, folded, unsure})
        EXPECT_EQ(view.value(weak, other, 0), -12) << other;
    for (const int other : {unseen, nothing, folded})
        EXPECT_EQ(view.status(other, unsure, 0), CellStatus::ambiguous) << other;
    EXPECT_EQ(view.status(folded, nothing, 0), CellStatus::no_echo);
    options.overlap = Overlap::mean;
    EXPECT_EQ(merge(domain, partials.all(), options).error().message,
              "AZSH of different sites cannot be mixed (each measures along its own beams); use "
              "the overlap rule maximum, not mean");
    EXPECT_EQ(default_overlap(Moment::divg), Overlap::nearest);
}

// Two radars see one smooth field, but the second radar is 2 dB too strong. Where the second
// radar's window ends, the second radar's weight is at most 0.034, which is half the weight of the
// first radar, because the first radar is 140 km nearer.
TEST(Mosaic, NoSeamWhereAWindowEnds) {
    GridSpec domain = default_spec(41, -76);
    domain.nx = 256;
    domain.ny = 64;
    domain.spacing_m = 4000;
    domain.levels_m = {3000};
    const SitePosition first{"KBGM", 41, -76, 500};
    const SitePosition second{"KENX", 41, -72, 500};
    const auto window = site_window(domain, second);
    ASSERT_TRUE(window);
    ASSERT_GT(window->first_x, 16) << "the window must end within the domain";
    const auto field = [](int ix, int iy) { return 30 + 10 * std::sin(ix / 40.0 + iy / 60.0); };
    Partials partials(domain);
    const auto fill_with = [&](double more) {
        return [&field, more](int ix, int iy, int, auto& status, float& value) {
            status = CellStatus::value;
            value = static_cast<float>(field(ix, iy) + more);
        };
    };
    partials.add(first, {0, 0, domain.nx, domain.ny}, two_bytes, fill_with(0));
    partials.add(second, *window, two_bytes, fill_with(2));
    const auto largest_step = [&](Overlap overlap) {
        MosaicOptions options;
        options.overlap = overlap;
        const auto made = merge(domain, partials.all(), options);
        const BrickView view = made->cells.view();
        double largest = 0;
        for (int iy = 0; iy < domain.ny; ++iy) {
            for (int ix = 1; ix < domain.nx; ++ix) {
                const double step = static_cast<double>(view.value(ix, iy, 0)) -
                                    static_cast<double>(view.value(ix - 1, iy, 0));
                largest = std::max(largest, std::abs(step - field(ix, iy) + field(ix - 1, iy)));
            }
        }
        return largest;
    };
    EXPECT_LT(largest_step(Overlap::distance_weighted), 0.1);
    EXPECT_GT(largest_step(Overlap::mean), 0.9) << "without weights there is a seam";
    EXPECT_GT(largest_step(Overlap::nearest), 1.9);
}

TEST(Mosaic, MeansBelowTheCodesAreClampedAndCounted) {
    GridSpec domain = square_spec(41, -75, 16);
    domain.levels_m = {1000};
    Partials partials(domain);
    const auto fill_with = [](CellStatus state) {
        return [state](int, int, int, auto& status, float& value) {
            status = state;
            value = -32;
        };
    };
    partials.add({"KAAA", 41, -75, 0}, {0, 0, 16, 16}, one_byte, fill_with(CellStatus::value));
    partials.add({"KBBB", 41, -75, 0}, {0, 0, 16, 16}, one_byte, fill_with(CellStatus::no_echo));
    const auto made = merge(domain, partials.all(), {});
    ASSERT_TRUE(made);
    // Within 2 km, the limit of -41.5 dBZ at 1 km is below -32 dBZ.
    EXPECT_EQ(made->cells.view().value(8, 8, 0), -32);
    EXPECT_GT(made->cells.clamped_count(), 0U);
    EXPECT_LT(made->cells.clamped_count(), 60U);
}

// docs/geometry.md states how near the merging's approximation c (arc^2 + height^2) is to the limit
// at the slant range over the 4/3 earth.
TEST(Mosaic, TheDetectionLimitIsThatOfTheSlantRange) {
    double largest_db = 0;
    for (const double altitude_m : {0.0, 3000.0}) {
        const BeamGeometry beam(40, altitude_m);
        for (double arc_m = 500; arc_m <= 460e3; arc_m *= 1.1) {
            for (double height_m = 0; height_m <= 21e3; height_m += 1000) {
                const double slant_m = beam.inverse({arc_m, height_m}).range_m;
                const double flat_m = std::hypot(arc_m, height_m - altitude_m);
                largest_db = std::max(largest_db, std::abs(20 * std::log10(slant_m / flat_m)));
            }
        }
    }
    EXPECT_LT(largest_db, 0.0125);
    EXPECT_GT(largest_db, 0.01);
}

TEST(Mosaic, WhatCannotBeMergedIsABadArgument) {
    Partials partials = random_partials(one_byte, 11);
    const std::vector<Partial> good = partials.all();
    const GridSpec& domain = partials.domain();
    const auto refused = [&](std::vector<Partial> all, const MosaicOptions& options,
                             std::string_view why) {
        const auto made = merge(domain, all, options);
        ASSERT_FALSE(made) << why;
        EXPECT_EQ(made.error().code, ErrorCode::bad_argument);
        EXPECT_NE(made.error().message.find(why), std::string::npos) << made.error().message;
        const auto whole = merge(domain, good, {});
        EXPECT_FALSE(update(whole->view(), all, {}, options));
    };
    const auto with = [](auto change) {
        MosaicOptions options;
        change(options);
        return options;
    };
    refused(good, with([](auto& o) { o.moment = Moment::vel; }), "along its own beams");
    refused(good, with([](auto& o) { o.moment = Moment::phi; }), "an offset of its own");
    refused(good, with([](auto& o) {
                o.moment = Moment::zdr;
                o.averaging = Averaging::in_z;
            }),
            "only reflectivity");
    refused(good, with([](auto& o) { o.length_m = 999; }), "length");
    refused(good, with([](auto& o) { o.length_m = std::nan(""); }), "length");
    refused(good, with([](auto& o) { o.threads = 0; }), "threads");
    const auto with_one = [&](auto change) {
        std::vector<Partial> all = good;
        change(all[2]);
        return all;
    };
    refused(with_one([&](Partial& p) { p.site = good[0].site; }), {}, "twice");
    refused(with_one([](Partial& p) { p.site.latitude_deg = std::nan(""); }), {}, "on the earth");
    refused(with_one([](Partial& p) { p.view.quantization.step = 1; }), {}, "quantized");
    GridSpec other = *good[2].view.spec;
    other.offset_x_cells += 1;
    refused(with_one([&](Partial& p) { p.view.spec = &other; }), {}, "whole bricks");
    refused(with_one([&](Partial& p) { p.view.codes = p.view.codes.first(16); }), {},
            "whole bricks");
    const auto elsewhere =
        std::make_shared<const SiteDistance>(domain, GridWindow{0, 0, 32, 32}, good[2].site);
    refused(with_one([&](Partial& p) { p.distance = elsewhere; }), {}, "another place");

    const auto previous = merge(domain, good, {});
    MosaicOptions counted{.counts = true};
    EXPECT_FALSE(update(previous->view(), good, {}, counted))
        << "the previous mosaic has no counts";
}

TEST(Mosaic, NamesAreReadAsTheyAreWritten) {
    for (const Overlap overlap :
         {Overlap::mean, Overlap::maximum, Overlap::nearest, Overlap::distance_weighted}) {
        EXPECT_EQ(overlap_from_name(overlap_name(overlap)), overlap);
    }
    EXPECT_FALSE(overlap_from_name("median"));
}

}  // namespace
}  // namespace stormcellar::grid
