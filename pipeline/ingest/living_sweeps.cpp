#include "pipeline/ingest/living_sweeps.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace stormcellar::pipeline {
namespace {

using SweepKey = ShelvedVolume::SweepKey;

constexpr std::chrono::minutes longest_standing{20};

MomentSet dealiased_moments() {
    MomentSet dealiased;
    for (const level2::Moment moment : level2::all_moments)
        dealiased.set(static_cast<std::size_t>(moment), level2::is_dealiased(moment));
    return dealiased;
}

// Adds the two dealiased sweeps with keys below `end` that are nearest in elevation. The function
// ignores sweeps that cannot be read.
void add_nearest_dealiased(const ShelvedVolume& from, SweepKey end, double elevation_deg,
                           std::vector<level2::Sweep>& known) {
    constexpr std::size_t most = 2;
    std::vector<std::pair<double, SweepKey>> nearest;
    for (auto kept = from.sweeps.begin(); kept != from.sweeps.lower_bound(end); ++kept)
        if (from.dealiased.has(kept->first, from.places.at(kept->first)))
            nearest.emplace_back(std::abs(kept->second.elevation_deg - elevation_deg), kept->first);
    std::ranges::sort(nearest);
    nearest.resize(std::min(nearest.size(), most));
    for (const auto& [apart_deg, key] : nearest) {
        auto sweep = from.dealiased.find(*from.shelf, key, from.places.at(key));
        if (sweep && *sweep) known.push_back(std::move(**sweep));
    }
}

// Returns the sweep by which the sweep `key` is judged: of the earlier sweeps of the same angle,
// the newest with dual polarization, or else the newest with reflectivity. Returns none if there is
// no such sweep, or if the sweep `key` itself has dual polarization.
std::optional<SweepKey> judging_sweep(const ShelvedVolume& from, SweepKey key) {
    const auto has = [](const ShelvedVolume::Kept& kept, level2::Moment moment) {
        return kept.measured.test(static_cast<std::size_t>(moment));
    };
    const ShelvedVolume::Kept& judged = from.sweeps.at(key);
    std::optional<SweepKey> newest;
    if (has(judged, level2::Moment::rho)) return newest;
    bool is_dual = false;
    for (auto kept = from.sweeps.begin(); kept != from.sweeps.lower_bound(key); ++kept) {
        const auto& [other, facts] = *kept;
        if (std::abs(facts.elevation_deg - judged.elevation_deg) >= same_elevation_deg) continue;
        const bool judges_better = has(facts, level2::Moment::rho);
        if (!judges_better && (is_dual || !has(facts, level2::Moment::ref))) continue;
        newest = other;
        is_dual = judges_better;
    }
    return newest;
}

// Removes the moments that are neither gridded nor needed for gridded moments.
void keep_gridded(level2::Sweep& sweep, MomentSet gridded) {
    std::erase_if(sweep.moments, [&](const level2::SweepMoment& kind) {
        return std::ranges::none_of(level2::all_moments, [&](level2::Moment moment) {
            return gridded.test(static_cast<std::size_t>(moment)) &&
                   level2::measured_moment(moment) == kind.moment;
        });
    });
}

// Returns `last` if the growing volume follows it within 20 minutes.
const ShelvedVolume* recent(const ShelvedVolume& growing, const ShelvedVolume* last) {
    const auto start = growing.facts.start_time();
    const auto last_start = last == nullptr ? std::nullopt : last->facts.start_time();
    const bool is_recent =
        start && last_start && *start > *last_start && *start - *last_start <= longest_standing;
    return is_recent ? last : nullptr;
}

}  // namespace

Result<level2::Sweep> LivingSweeps::wanted_echo(const ShelvedVolume& from, SweepKey key) const {
    const SweepShelf::Place& place = from.places.at(key);
    if (options_.quality <= 0) return from.shelf->get(place);
    if (auto kept = from.weather.find(*from.shelf, key, place)) return std::move(*kept);
    auto sweep = from.shelf->get(place);
    if (!sweep) return sweep;
    std::vector<level2::Sweep> others;
    if (const auto judging = judging_sweep(from, key)) {
        auto other = from.shelf->get(from.places.at(*judging));
        if (!other) return other;
        others.push_back(std::move(*other));
    }
    const retrieve::LeftOutEcho left_out = retrieve::keep_weather(*sweep, others, options_.quality);
    keep_gridded(*sweep, from.sweeps.at(key).moments);
    // Without space on the shelf, the next living grid judges the sweep again.
    (void)from.weather.keep(*from.shelf, key, place, *sweep, left_out);
    return sweep;
}

Result<level2::Sweep> LivingSweeps::dealiased_sweep(const ShelvedVolume& from, SweepKey key,
                                                    const ShelvedVolume* last) {
    const SweepShelf::Place& place = from.places.at(key);
    if (auto kept = from.dealiased.find(*from.shelf, key, place)) return std::move(*kept);
    const auto received = wanted_echo(from, key);
    if (!received) return pass_on(received);
    const double elevation_deg = received->mean_elevation_deg();
    std::vector<level2::Sweep> known;
    add_nearest_dealiased(from, key, elevation_deg, known);
    if (last != nullptr && !last->sweeps.empty())
        add_nearest_dealiased(*last, last->sweeps.rbegin()->first + 1, elevation_deg, known);
    const MomentSet gridded = from.sweeps.at(key).moments;
    std::vector<level2::Moment> shear;
    for (const level2::Moment moment : {level2::Moment::azsh, level2::Moment::divg})
        if (gridded.test(static_cast<std::size_t>(moment))) shear.push_back(moment);
    level2::Sweep made = retrieve::dealiased_sweep(*received, options_.dealiasing, known, shear);
    ++dealiased_;
    // Without space on the shelf, the next living grid dealiases the sweep again.
    (void)from.dealiased.keep(*from.shelf, key, place, made);
    return made;
}

Status LivingSweeps::add(const ShelvedVolume& from, SweepKey key, MomentSet moments, bool stands,
                         const ShelvedVolume* last) {
    const MomentSet derived = moments & dealiased_moments(), measured = moments & ~derived;
    if (measured.any()) {
        auto sweep = wanted_echo(from, key);
        if (!sweep) return pass_on(sweep);
        sweeps_.push_back({std::move(*sweep), measured, stands, from.weather.left_out(key)});
    }
    if (derived.any()) {
        auto sweep = dealiased_sweep(from, key, last);
        if (!sweep) return pass_on(sweep);
        sweeps_.push_back({std::move(*sweep), derived, stands, from.weather.left_out(key)});
    }
    return {};
}

Result<LivingSweeps> LivingSweeps::read(const ShelvedVolume& growing, const ShelvedVolume* last,
                                        MomentSet moments,
                                        const retrieve::DerivedOptions& options) {
    LivingSweeps read(options);
    read.volume_ = growing.facts;
    last = recent(growing, last);
    // Returns the moments that a new sweep near this elevation has.
    const auto come_again = [&growing](double elevation_deg) {
        MomentSet come;
        for (const auto& [key, kept] : growing.sweeps) {
            if (std::abs(kept.elevation_deg - elevation_deg) < same_elevation_deg)
                come |= kept.moments;
        }
        return come;
    };
    if (last != nullptr) {
        for (const auto& [key, kept] : last->sweeps) {
            const MomentSet stand = kept.moments & moments & ~come_again(kept.elevation_deg);
            if (Status added = read.add(*last, key, stand, true, nullptr); !added)
                return pass_on(added);
        }
    }
    for (const auto& [key, kept] : growing.sweeps) {
        const MomentSet counts = kept.moments & moments;
        if (Status added = read.add(growing, key, counts, false, last); !added)
            return pass_on(added);
    }
    return read;
}

level2::Volume& LivingSweeps::volume_of(level2::Moment moment) {
    for (std::size_t i = 0; i < lent_.size(); ++i)
        sweeps_[lent_[i]].sweep = std::move(volume_.sweeps[i]);
    lent_.clear();
    volume_.sweeps.clear();
    standing_ = 0;
    left_out_ = {};
    for (std::size_t i = 0; i < sweeps_.size(); ++i) {
        One& one = sweeps_[i];
        if (!one.moments.test(static_cast<std::size_t>(moment))) continue;
        volume_.sweeps.push_back(std::move(one.sweep));
        lent_.push_back(i);
        left_out_ += one.left_out;
        if (one.stands) ++standing_;
    }
    return volume_;
}

}  // namespace stormcellar::pipeline
