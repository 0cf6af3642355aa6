#include "stormcellar/grid/sweep_lookup.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "tests/grid/real_volume.h"

namespace stormcellar::grid {
namespace {

using level2::Moment;

constexpr double near_border_m = 0.2;
constexpr double near_border_deg = 1e-4;
constexpr double half_beam_deg = 0.475;

struct RealVolume {
    std::shared_ptr<const level2::Volume> volume;
    SitePosition site;
};

RealVolume volume_of(const std::string& name) {
    auto volume = std::make_shared<level2::Volume>(real_volume("volumes/" + name));
    const SitePosition site = site_of(*volume);
    return {std::move(volume), site};
}

double turn_deg(double from, double to) {
    return std::remainder(to - from, 360.0);
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    return values[values.size() / 2];
}

// Finds gates the slow and obvious way: searches every radial and every gate. Shares only the
// decoded volume and the formula of the beam with SweepLookup.
class SlowSweep {
  public:
    SlowSweep(const level2::Sweep& sweep, Moment moment, const SitePosition& site)
        : sweep_(sweep), moment_(moment), beam_(site.latitude_deg, site.altitude_m) {
        std::vector<double> elevations;
        for (std::size_t i = 0; i < sweep.radials.size(); ++i) {
            if (kind_of(i) != nullptr)
                elevations.push_back(static_cast<double>(sweep.radials[i].elevation_deg));
        }
        elevation_deg_ = median(elevations);
        std::vector<double> azimuths;
        for (std::size_t i = 0; i < sweep.radials.size(); ++i) {
            const double off = static_cast<double>(sweep.radials[i].elevation_deg) - elevation_deg_;
            if (kind_of(i) == nullptr || std::abs(off) > half_beam_deg) continue;
            used_.push_back(i);
            azimuths.push_back(static_cast<double>(sweep.radials[i].azimuth_deg));
        }
        std::ranges::sort(azimuths);
        std::vector<double> steps;
        for (std::size_t i = 0; i + 1 < azimuths.size(); ++i)
            steps.push_back(azimuths[i + 1] - azimuths[i]);
        spacing_deg_ =
            std::max(static_cast<double>(sweep.azimuth_spacing_deg), std::min(2.0, median(steps)));
    }

    struct Answer {
        GateValue value;
        std::int64_t radial = -1;
        std::int32_t gate = -1;
        bool is_near_border = false;
    };

    [[nodiscard]] Answer at(PolarPoint place) const {
        Answer answer;
        // The nearest radial on each side of the place.
        double before = -400;
        double after = 400;
        std::size_t nearest = used_.front();
        for (const std::size_t i : used_) {
            const double turn =
                turn_deg(place.azimuth_deg, static_cast<double>(sweep_.radials[i].azimuth_deg));
            if (turn <= 0) before = std::max(before, turn);
            if (turn > 0) after = std::min(after, turn);
            const double best = turn_deg(place.azimuth_deg,
                                         static_cast<double>(sweep_.radials[nearest].azimuth_deg));
            // If two radials have equal azimuths, the later radial counts.
            if (std::abs(turn) <= std::abs(best)) nearest = i;
        }
        const double off = std::min(after, -before);
        const bool is_gap = after - before > 1.5 * spacing_deg_;
        answer.is_near_border = std::abs(after + before) < near_border_deg ||
                                (is_gap && std::abs(off - spacing_deg_ / 2) < near_border_deg);
        if (is_gap && off > spacing_deg_ / 2) return answer;
        const level2::SweepMoment& kind = *kind_of(nearest);
        for (std::int32_t gate = 0; gate < kind.gate_counts[nearest]; ++gate) {
            // A gate whose center is behind the antenna is not seen, even if part of the gate is in
            // front of the antenna.
            if (kind.range_m(gate) < 0) continue;
            const double from = arc_of(kind.range_m(gate) - 0.5 * kind.gate_spacing_m);
            const double to = arc_of(kind.range_m(gate) + 0.5 * kind.gate_spacing_m);
            if (std::abs(place.arc_m - from) < near_border_m ||
                std::abs(place.arc_m - to) < near_border_m)
                answer.is_near_border = true;
            if (place.arc_m < from || place.arc_m >= to) continue;
            answer.radial = static_cast<std::int64_t>(nearest);
            answer.gate = gate;
            switch (kind.status(nearest, gate)) {
                case level2::GateStatus::valid:
                    answer.value = {CellStatus::value, kind.value_of(kind.code(nearest, gate))};
                    break;
                case level2::GateStatus::below_threshold:
                    answer.value.status = CellStatus::no_echo;
                    break;
                case level2::GateStatus::range_folded:
                    answer.value.status = CellStatus::range_folded;
                    break;
                case level2::GateStatus::ambiguous:
                    answer.value.status = CellStatus::ambiguous;
                    break;
                case level2::GateStatus::no_data:
                    break;
            }
        }
        return answer;
    }

    [[nodiscard]] double elevation_deg() const { return elevation_deg_; }

  private:
    [[nodiscard]] const level2::SweepMoment* kind_of(std::size_t radial) const {
        for (const level2::SweepMoment& kind : sweep_.moments) {
            if (kind.moment == moment_ && kind.gate_counts[radial] > 0) return &kind;
        }
        return nullptr;
    }
    [[nodiscard]] double arc_of(double range_m) const {
        return beam_.forward({range_m, elevation_deg_}).arc_m;
    }

    const level2::Sweep& sweep_;
    Moment moment_;
    BeamGeometry beam_;
    double elevation_deg_ = 0;
    double spacing_deg_ = 1;
    std::vector<std::size_t> used_;
};

struct Case {
    const char* file;
    Moment moment;
    std::optional<double> elevation_deg;
    std::size_t sweep;  // number of the expected sweep in `stormcellar info`
};

// Returns cases of message 1, with gates of 1 km and 250 m, and of message 31, with radials of half
// a degree and of one degree.
const std::vector<Case>& cases() {
    static const std::vector<Case> all = {
        {"KTLX19990503_235621.gz", Moment::ref, std::nullopt, 0},
        {"KTLX19990503_235621.gz", Moment::vel, 0.5, 1},
        {"KTLX19990503_235621.gz", Moment::ref, 19.5, 15},
        {"KLBB20160601_150025_V06", Moment::ref, 0.5, 0},
        {"KTLX19990503_235621.gz", Moment::vel, 3.4, 5},
        {"KLBB20160601_150025_V06", Moment::vel, 0.5, 1},
        {"KLBB20160601_150025_V06", Moment::rho, 1.4, 2},
        {"KLBB20160601_150025_V06", Moment::zdr, 9, 8},
    };
    return all;
}

struct Compared {
    std::map<CellStatus, int> places;  // number of places with each state
    int skipped = 0;
};

// Compares the lookup with the slow search at random places, some of them beyond the last gate.
void compare(const SweepLookup& lookup, const level2::Sweep& sweep, const SlowSweep& slow,
             std::mt19937& random, Compared& compared) {
    std::uniform_real_distribution<double> azimuths(0, 360);
    std::uniform_real_distribution<double> arcs(0, 1.02 * lookup.facts().greatest_arc_m);
    for (int i = 0; i < 4000; ++i) {
        const PolarPoint place{azimuths(random), arcs(random)};
        const SlowSweep::Answer wanted = slow.at(place);
        if (wanted.is_near_border) {
            ++compared.skipped;
            continue;
        }
        const GateValue found = lookup.at(place);
        ASSERT_EQ(found.status, wanted.value.status) << place.azimuth_deg << " " << place.arc_m;
        ++compared.places[found.status];
        if (found.status == CellStatus::value) {
            ASSERT_EQ(found.value, wanted.value.value);
        }
        const auto position = lookup.position(place);
        ASSERT_EQ(position.has_value(), wanted.gate >= 0);
        if (!position) continue;
        ASSERT_EQ(position->radial, wanted.radial);
        ASSERT_EQ(position->gate, wanted.gate);
        ASSERT_EQ(position->time, sweep.radials[position->radial].time);
    }
}

TEST(SweepLookup, EqualsTheGatesValueForValue) {
    STORMCELLAR_NEED_DATA();
    std::mt19937 random(20250312);
    std::map<std::string, std::map<CellStatus, int>> by_file;
    for (const Case& one : cases()) {
        SCOPED_TRACE(std::string(one.file) + " sweep " + std::to_string(one.sweep));
        const RealVolume real = volume_of(one.file);
        const level2::Sweep& sweep = real.volume->sweeps[one.sweep];
        const SlowSweep slow(sweep, one.moment, real.site);
        for (const SweepWish& wish :
             {SweepWish{.elevation_deg = one.elevation_deg}, SweepWish{.number = one.sweep}}) {
            const auto lookup =
                SweepLookup::find(real.volume, real.site, one.moment, half_beam_deg, wish);
            ASSERT_TRUE(lookup);
            ASSERT_EQ(lookup->facts().number, one.sweep);
            EXPECT_DOUBLE_EQ(lookup->facts().elevation_deg, slow.elevation_deg());
            Compared compared;
            compare(*lookup, sweep, slow, random, compared);
            if (HasFatalFailure()) return;
            EXPECT_GT(compared.places[CellStatus::value], 40);
            EXPECT_LT(compared.skipped, 80) << "few places are beside a border";
            for (const auto& [status, places] : compared.places)
                by_file[one.file][status] += places;
        }
    }
    for (auto& [file, places] : by_file) {
        EXPECT_GT(places[CellStatus::value], 1000) << file;
        EXPECT_GT(places[CellStatus::no_echo], 1000) << file;
        EXPECT_GT(places[CellStatus::range_folded], 100) << file;
        EXPECT_GT(places[CellStatus::not_seen], 100) << file << ": beyond the last gate";
    }
}

TEST(SweepLookup, FindsSweepsByNumberAngleAndTime) {
    STORMCELLAR_NEED_DATA();
    const RealVolume real = volume_of("KLBB20160601_150025_V06");
    const auto number_of = [&](Moment moment, const SweepWish& wish) {
        const auto found = SweepLookup::find(real.volume, real.site, moment, half_beam_deg, wish);
        return found ? static_cast<int>(found->facts().number) : -1;
    };
    EXPECT_EQ(number_of(Moment::ref, {}), 0)
        << "the lowest elevation, whose Doppler sweep also has reflectivity";
    EXPECT_EQ(number_of(Moment::vel, {}), 1);
    EXPECT_EQ(number_of(Moment::ref, {.number = 1}), 1);
    EXPECT_EQ(number_of(Moment::ref, {.elevation_deg = 3}), 5);
    EXPECT_EQ(number_of(Moment::ref, {.elevation_deg = 19}), 10);
    const auto far = SweepLookup::find(real.volume, real.site, Moment::vel, half_beam_deg,
                                       {.elevation_deg = 45});
    ASSERT_FALSE(far);
    EXPECT_EQ(far.error().code, ErrorCode::not_found);
    EXPECT_EQ(far.error().message,
              "no sweep with VEL is within 1 degree of 45 degrees; the sweeps with it have "
              "elevations of 0.5, 1.5, 2.4, 3.4, 4.3, 6.0, 9.9, 14.6, 19.5 degrees");
    const auto none =
        SweepLookup::find(real.volume, real.site, Moment::vel, half_beam_deg, {.number = 0});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().code, ErrorCode::not_found);
    EXPECT_THAT(none.error().message, ::testing::HasSubstr("1, 3, 4, 5"));
    const auto beyond =
        SweepLookup::find(real.volume, real.site, Moment::zdr, half_beam_deg, {.number = 11});
    ASSERT_FALSE(beyond);
    EXPECT_THAT(beyond.error().message, ::testing::StartsWith("there is no sweep 11; the sweeps "
                                                              "with ZDR are 0, 2, 4"));
    EXPECT_THAT(elevations_deg(*real.volume, Moment::vel, half_beam_deg), ::testing::SizeIs(9));
}

// With SAILS, the lowest sweep is repeated later in the volume, and the lookup finds the newest
// repetition.
TEST(SweepLookup, TakesTheNewestOfSeveralSweepsOfAnAngle) {
    STORMCELLAR_NEED_DATA();
    const RealVolume real = volume_of("KLBB20160601_150025_V06");
    auto again = std::make_shared<level2::Volume>(*real.volume);
    again->sweeps.push_back(again->sweeps.front());
    for (level2::Radial& radial : again->sweeps.back().radials)
        radial.time += std::chrono::minutes{3};
    const auto newest = SweepLookup::find(again, real.site, Moment::rho, half_beam_deg, {});
    ASSERT_TRUE(newest);
    EXPECT_EQ(newest->facts().number, 11U);
    EXPECT_LE(newest->facts().start, newest->facts().end);
    const auto start = again->sweeps.front().radials.front().time;
    const auto first =
        SweepLookup::find(again, real.site, Moment::rho, half_beam_deg, {.nearest_to = start});
    ASSERT_TRUE(first);
    EXPECT_EQ(first->facts().number, 0U);
    EXPECT_EQ(first->facts().start, start);
    EXPECT_EQ(elevations_deg(*again, Moment::rho, half_beam_deg),
              elevations_deg(*real.volume, Moment::rho, half_beam_deg))
        << "a repeated sweep adds no elevation";
}

// Uses a sweep without the radials from 90 to 100 degrees, where nothing is seen.
TEST(SweepLookup, MissingRadialsAreNotSeen) {
    STORMCELLAR_NEED_DATA();
    const RealVolume real = volume_of("KLBB20160601_150025_V06");
    auto cut = std::make_shared<level2::Volume>(*real.volume);
    for (level2::SweepMoment& kind : cut->sweeps[0].moments) {
        for (std::size_t i = 0; i < kind.gate_counts.size(); ++i) {
            const float azimuth = cut->sweeps[0].radials[i].azimuth_deg;
            if (azimuth > 90 && azimuth < 100) kind.gate_counts[i] = 0;
        }
    }
    const auto lookup =
        SweepLookup::find(cut, real.site, Moment::ref, half_beam_deg, {.number = 0});
    ASSERT_TRUE(lookup);
    EXPECT_EQ(lookup->at({95, 50e3}).status, CellStatus::not_seen);
    EXPECT_FALSE(lookup->position({95, 50e3}));
    EXPECT_NE(lookup->at({89, 50e3}).status, CellStatus::not_seen);
    EXPECT_NE(lookup->at({101, 50e3}).status, CellStatus::not_seen);
    EXPECT_EQ(lookup->at({180, 1e6}).status, CellStatus::not_seen)
        << "the place is beyond the last gate";
}

}  // namespace
}  // namespace stormcellar::grid
