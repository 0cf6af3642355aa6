#include "pipeline/ingest/take_volumes.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/ranges.h>

#include "base/steady_time.h"
#include "level2/decode/volume_checks.h"
#include "level2/messages/message_2.h"
#include "retrieve/derived/quality_moment.h"

namespace stormcellar::pipeline {
namespace {

using catalog::FileState;

// A radar's file holds one volume. A joined file may hold the volumes of some hours, and one job
// grids them all.
constexpr std::size_t most_volumes = 64;

// Returns a reason that names the station, because the row is stored among the files of unknown
// stations.
std::string of_other_station(const std::string& station, const std::string& reason) {
    const std::string text =
        fmt::format("is of {}, a station that [ingest] stations does not accept", station);
    return reason.empty() ? text : text + "; " + reason;
}

// A file with at most this many radials may be a chunk. A radar's record holds 120 radials at most.
constexpr std::size_t most_radials_of_a_chunk = 120;

bool is_lone_chunk(const level2::Decoded& decoded) {
    return !decoded.volume.header && decoded.report.ldm_records == 1U &&
           !decoded.volume.sweeps.empty() &&
           decoded.volume.radial_count() <= most_radials_of_a_chunk;
}

constexpr std::string_view lone_chunk_text =
    "looks like one chunk of a volume: chunks are joined only if their names hold "
    "YYYYMMDD-HHMMSS-NUMBER-KIND or LDM's key";

}  // namespace

Result<IngestOutcome> TakeVolumes::take(level2::Decoded decoded, MayBePartial partial) {
    note(decoded);
    std::vector<level2::Volume> volumes = level2::split_volumes(std::move(decoded));
    if (volumes.size() != 1) use_dealiased_ = nullptr;
    if (volumes.size() > most_volumes) {
        return reject(ErrorCode::unsupported,
                      fmt::format("holds {} volumes, more than the {} that a raw file may hold",
                                  volumes.size(), most_volumes));
    }
    describe(volumes);
    facts_.state = FileState::seen;
    if (Status stored = context_.record(facts_); !stored) return pass_on(stored);
    const bool has_ended = !volumes.empty() && level2::has_ended(volumes.back());
    if (!has_ended && partial == MayBePartial::no) {
        outcome_.ending = ended::Incomplete{};
        return std::move(outcome_);
    }
    facts_.state = reading_.is_complete ? FileState::complete : FileState::partial;
    if (context_.store == nullptr) {
        outcome_.ending = ended::Registered{};
        return settle();
    }
    outcome_.ending = ended::NoMoment{};
    if (facts_.volumes.empty()) return settle();
    return grid_all(volumes);
}

// Notes what the decoder's report says about the whole file.
void TakeVolumes::note(const level2::Decoded& decoded) {
    facts_.reason = reason_of(decoded.report);
    outcome_.lone_chunk = is_lone_chunk(decoded);
    if (outcome_.lone_chunk) {
        facts_.reason = fmt::format("{}{}{}", lone_chunk_text, facts_.reason.empty() ? "" : "; ",
                                    facts_.reason);
    }
    reading_.is_complete = decoded.report.complete;
    reading_.damaged = decoded.report.damaged;
    if (decoded.report.rda_status)
        reading_.troubles = level2::rda_troubles(*decoded.report.rda_status);
}

// Adds what is known about the volumes and their stations to the rows and the outcome.
void TakeVolumes::describe(const std::vector<level2::Volume>& volumes) {
    for (const level2::Volume& volume : volumes) {
        if (volume.radial_count() == 0) continue;  // metadata without radials are no volume
        facts_.volumes.push_back(facts_of(volume, reading_.damaged));
        outcome_.newest_radial = std::max(outcome_.newest_radial, facts_.volumes.back().end_time);
    }
    for (const level2::Volume& volume : volumes)
        context_.admit(volume.station);
    if (!volumes.empty()) {
        facts_.station = volumes.front().station;
        outcome_.volume_time = volumes.front().start_time();
    }
    outcome_.station = context_.taken_station(facts_.station);
    if (!facts_.station.empty() && outcome_.station.empty())
        facts_.reason = of_other_station(facts_.station, facts_.reason);
    outcome_.reason = facts_.reason;
}

// Returns the troubles of the radar in the form in which grids store them.
std::vector<std::string> TakeVolumes::troubles_of(const std::string& station) const {
    if (reading_.troubles.empty()) return {};
    return {fmt::format("{}: {}", station, fmt::join(reading_.troubles, ", "))};
}

bool TakeVolumes::is_partial(const level2::Volume& volume) const {
    return reading_.damaged || !level2::is_complete(volume);
}

// Returns true if another file with the same volume exists.
Result<bool> TakeVolumes::has_rival(const level2::Volume& volume) const {
    const auto start = volume.start_time();
    const std::string station = context_.taken_station(volume.station);
    const auto rows = context_.catalog.list(station, {start, start, false});
    if (!rows && rows.error().code == ErrorCode::not_found) return false;
    if (!rows) return pass_on(rows);
    return std::ranges::any_of(*rows, [&](const catalog::CatalogEntry& row) {
        const bool is_gone = row.state == FileState::gone || row.state == FileState::rejected;
        return !is_gone && row.path != facts_.path && stamp_of(row.path).has_value();
    });
}

Result<IngestOutcome> TakeVolumes::reject(ErrorCode code, std::string why) {
    return context_.reject(facts_, {code, std::move(why)}, std::move(outcome_));
}

Result<IngestOutcome> TakeVolumes::settle() {
    if (Status stored = context_.record(facts_); !stored) return pass_on(stored);
    return std::move(outcome_);
}

// Grids the volumes, and only then settles the row in the catalog. So the file is gridded again
// after a crash.
Result<IngestOutcome> TakeVolumes::grid_all(std::vector<level2::Volume>& volumes) {
    bool has_other_station = false;
    for (level2::Volume& volume : volumes) {
        if (!volume.station.empty() && context_.taken_station(volume.station).empty()) {
            has_other_station = true;
            continue;
        }
        if (!volume.start_time()) {
            return reject(ErrorCode::corrupt, "cannot be gridded: it holds no plausible time");
        }
        const std::vector<std::string> notes = keep_wanted_echo(volume);
        if (const Status gridded = grid(volume, notes); !gridded) {
            if (gridded.error().cause() != Cause::data) return pass_on(gridded);
            return reject(gridded.error().code, "cannot be gridded: " + gridded.error().message);
        }
        if (const Status kept = keep_mosaics(volume, notes); !kept) return pass_on(kept);
    }
    const bool has_part = !context_.options.own_grids && !outcome_.partials.empty();
    if (!outcome_.grids.empty() || has_part || outcome_.not_kept > 0) {
        outcome_.ending = ended::Gridded{};
    } else if (has_other_station && std::holds_alternative<ended::NoMoment>(outcome_.ending)) {
        outcome_.ending = ended::OtherStation{};
    }
    return settle();
}

std::vector<std::string> TakeVolumes::keep_wanted_echo(level2::Volume& volume) {
    const double least = context_.options.derived.quality;
    if (least <= 0) return {};
    const auto start = std::chrono::steady_clock::now();
    const retrieve::LeftOutEcho left_out = retrieve::keep_weather(volume, least);
    outcome_.grid_s += seconds_since(start);
    return {retrieve::weather_note(least, left_out)};
}

// Makes the site's own grids, if these are made at all and the volume has one of the moments.
Status TakeVolumes::grid(const level2::Volume& volume, const std::vector<std::string>& notes) {
    if (!context_.options.own_grids) {
        (void)SiteGrids::has_place(volume, outcome_);
        return {};
    }
    const auto has = [&](level2::Moment moment) {
        return level2::holds(volume, level2::measured_moment(moment));
    };
    if (std::ranges::none_of(context_.options.moments, has)) return {};
    const auto rival = has_rival(volume);
    if (!rival) return pass_on(rival);
    const GridSource source{facts_.path.filename().string(), is_partial(volume), *rival,
                            troubles_of(volume.station), notes};
    return context_.site_grids->keep(
        volume, source, context_.share_of(context_.options.grid_threads), outcome_, use_dealiased_);
}

// Makes partials and frames. If a domain cannot use the volume, does not reject the file, because
// the site's own grid is stored.
Status TakeVolumes::keep_mosaics(const level2::Volume& volume,
                                 const std::vector<std::string>& notes) {
    const auto antenna = level2::antenna_position(volume);
    if (context_.mosaics.is_idle() || !antenna || volume.station.empty()) return {};
    const grid::SitePosition site{volume.station, antenna->latitude_deg, antenna->longitude_deg,
                                  antenna->altitude_m};
    VolumeSource source{volume, site, facts_.path.filename().string()};
    const auto rival = has_rival(volume);
    if (!rival) return pass_on(rival);
    source.has_rival = *rival;
    source.partial = is_partial(volume);
    source.radar_troubles = troubles_of(site.icao);
    if (antenna->disagreement) source.notes.push_back(*antenna->disagreement);
    source.notes.insert(source.notes.end(), notes.begin(), notes.end());
    const auto start = std::chrono::steady_clock::now();
    const auto kept =
        context_.mosaics.take_in(source, context_.share_of(context_.options.grid_threads));
    outcome_.mosaic_s += seconds_since(start);
    if (!kept) {
        if (kept.error().cause() != Cause::data) return pass_on(kept);
        outcome_.reason = "cannot be added to a mosaic: " + kept.error().message;
        return {};
    }
    outcome_.partials.insert(outcome_.partials.end(), kept->partials.begin(), kept->partials.end());
    if (!kept->problems.empty())
        outcome_.reason = "left out of a mosaic: " + kept->problems.front();
    outcome_.frames.insert(outcome_.frames.end(), kept->frames.begin(), kept->frames.end());
    return {};
}

}  // namespace stormcellar::pipeline
