// Operations on the sweeps of a raw volume, their gates and the wind that they show.
#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <utility>

#include "base/checksum.h"
#include "level2/decode/volume_checks.h"
#include "pipeline/drop/cataloged_volume.h"
#include "retrieve/wind/station_profile.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/sweep_choice.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "web/data/grids/compressed.h"
#include "web/data/grids/packed_sweep.h"
#include "web/doors/api/operations.h"
#include "web/doors/pictures/picture_answers.h"

namespace stormcellar::web {
namespace {

// Limit of a decoded volume. It usually takes some tens of megabytes.
constexpr std::uint64_t most_volume_bytes = std::uint64_t{256} << 20;

struct FoundVolume {
    std::shared_ptr<const catalog::CatalogReader> catalog;
    catalog::CatalogEntry entry;
    std::string key;  // changes when the volume's file changes
};

// Finds the volume in the catalog that starts at the time. If several do, takes the last, because a
// volume that is sent again replaces the earlier ones. Uses a volume whose file is gone only if all
// files are gone.
Answered<FoundVolume> find_cataloged(const ApiCall& call) {
    const auto icao = icao_of(call.path_value("station"));
    if (!icao) return refuse(json_error(404, "there is no such station"));
    auto catalog = call.state.catalog();
    if (!catalog) return refuse(catalog.error());
    std::optional<UtcTime> start;
    const std::string time_text = call.path_value("time");
    if (time_text == "latest") {
        const auto latest = (*catalog)->latest(*icao);
        if (!latest) return refuse(latest.error());
        if (*latest) start = (*latest)->volume.start_time;
    } else {
        const auto time = parse_utc(time_text, now_utc());
        if (!time) return refuse(json_error(400, "time: " + time.error().message));
        start = *time;
    }
    std::optional<catalog::CatalogEntry> found;
    if (start) {
        const auto entries = (*catalog)->list(*icao, {*start, *start, false});
        if (!entries) return refuse(entries.error());
        const auto rank = [](const catalog::CatalogEntry& entry) {
            return std::pair(entry.state != catalog::FileState::gone, entry.generation);
        };
        for (const catalog::CatalogEntry& entry : *entries)
            if (!found || rank(entry) >= rank(*found)) found = entry;
    }
    if (!found) return refuse(json_error(404, "there is no such volume"));
    if (found->state == catalog::FileState::gone) {
        return refuse(json_error(410, "the file of the volume was removed by its owner"));
    }
    // For a volume in chunks, the row has the path and the hash of the first chunk only.
    const auto rows = pipeline::hash_of_growing_rows(**catalog, *found);
    if (!rows) return refuse(rows.error());
    std::string key = fmt::format(
        "{}/{}/{}/{}/{}/{}/{}", found->path.native(), found->size_bytes, found->modified_ns,
        found->content_hash, start ? format_utc(*start) : "", found->volume.radial_count, *rows);
    return FoundVolume{std::move(*catalog), std::move(*found), std::move(key)};
}

// Decodes the volume that has the row's start, because a file may hold several volumes.
Result<ApiState::DecodedVolume> decode_found(const FoundVolume& found) {
    auto raw = pipeline::read_cataloged_volume(*found.catalog, found.entry);
    if (!raw) return pass_on(raw);
    level2::DecodeOptions options;
    options.output_limit_bytes = most_volume_bytes;
    options.fallback_station = found.entry.station;
    auto decoded = level2::decode(raw->bytes, options);
    if (!decoded) return pass_on(decoded);
    auto volumes = level2::split_volumes(std::move(*decoded));
    for (level2::Volume& volume : volumes) {
        if (volumes.size() > 1 && volume.start_time() != found.entry.volume.start_time) continue;
        return std::make_shared<const level2::Volume>(std::move(volume));
    }
    return fail(ErrorCode::not_found, "the file no longer holds the volume");
}

// Returns the kept volume if it is the requested one. Otherwise decodes the requested volume, which
// takes long.
Answered<ApiState::DecodedVolume> volume_of(const ApiCall& call, const FoundVolume& found) {
    if (auto kept = call.state.find_volume(found.key)) return kept;
    if (call.must_be_quick) return refuse(takes_long());
    auto decoded = decode_found(found);
    if (!decoded) return refuse(decoded.error());
    call.state.keep_volume(found.key, *decoded);
    return *decoded;
}

// As volume_of(), but also derives the wanted moment, and removes echo whose probability of weather
// is less than `quality`. If all echo is kept and the wanted moment comes from velocities, the
// volume has only velocities, VELD and the wanted moment.
Answered<ApiState::DecodedVolume> derived_volume_of(const ApiCall& call, const FoundVolume& found,
                                                    level2::Moment wanted, double quality) {
    const bool is_derived = level2::facts_of(wanted).is_derived;
    const std::string key =
        fmt::format("{}/{}/{}", found.key, is_derived ? level2::moment_name(wanted) : "", quality);
    if (auto kept = call.state.find_volume(key)) return kept;
    if (call.must_be_quick) return refuse(takes_long());
    const auto measured = volume_of(call, found);
    if (!measured) return measured;
    retrieve::DerivedOptions options;
    options.quality = quality;
    auto made = retrieve::derived_velocities(**measured, std::array{wanted}, options);
    if (!made) return refuse(made.error());
    auto derived = std::make_shared<const level2::Volume>(std::move(made->volume));
    call.state.keep_volume(key, derived);
    return derived;
}

// Returns the sweeps that `stormcellar frame --product ppi` would draw. For each moment, this is
// one sweep of each elevation.
std::set<std::pair<level2::Moment, std::size_t>> chosen_sweeps(const level2::Volume& volume,
                                                               std::string_view station) {
    std::set<std::pair<level2::Moment, std::size_t>> chosen;
    const double half_beam_deg = grid::beam_width_of(station) / 2;
    std::set<level2::Moment> moments;
    for (const level2::Sweep& sweep : volume.sweeps)
        for (const level2::SweepMoment& gates : sweep.moments)
            moments.insert(gates.moment);
    for (const level2::Moment moment : moments)
        for (const grid::ChosenSweep& sweep : grid::choose_sweeps(volume, moment, half_beam_deg))
            chosen.emplace(moment, sweep.sweep_index);
    return chosen;
}

// Returns the ICD's abbreviation of the waveform by which a sweep was measured; empty if the volume
// does not tell its pattern.
std::string_view waveform_of(const level2::Volume& volume, const level2::Sweep& sweep) {
    constexpr std::array<std::string_view, 6> names{"", "CS", "CD/W", "CD/WO", "B", "SPP"};
    const auto cut = static_cast<std::size_t>(sweep.elevation_number) - 1;
    if (sweep.elevation_number < 1 || !volume.vcp_message) return {};
    const auto& cuts = volume.vcp_message->cuts;
    return cut < cuts.size() && cuts[cut].waveform < names.size() ? names[cuts[cut].waveform] : "";
}

ApiJson sweep_json(const level2::Volume& volume, std::size_t number,
                   const std::set<std::pair<level2::Moment, std::size_t>>& chosen) {
    const level2::Sweep& sweep = volume.sweeps[number];
    ApiJson moments = ApiJson::array();
    for (const level2::SweepMoment& gates : sweep.moments) {
        const auto add = [&](level2::Moment moment, int bits) {
            moments.push_back({{"moment", level2::moment_name(moment)},
                               {"units", level2::moment_units(moment)},
                               {"first_gate_m", gates.first_gate_m},
                               {"gate_spacing_m", gates.gate_spacing_m},
                               {"gates", gates.gate_stride},
                               {"bits", bits},
                               {"chosen", chosen.contains({gates.moment, number})}});
        };
        add(gates.moment, gates.word_size_bits);
        for (const level2::MomentFacts& facts : level2::moment_facts)
            if (facts.is_derived && facts.measured == gates.moment)
                add(facts.moment, level2::is_dealiased(facts.moment) ? 16 : 8);
    }
    ApiJson json{{"sweep", number},
                 {"elevation_number", sweep.elevation_number},
                 {"elevation_deg", sweep.mean_elevation_deg()},
                 {"radials", sweep.radials.size()},
                 {"moments", moments}};
    if (const auto waveform = waveform_of(volume, sweep); !waveform.empty())
        json["waveform"] = waveform;
    if (!sweep.radials.empty()) {
        json["start"] = format_utc(sweep.radials.front().time);
        json["end"] = format_utc(sweep.radials.back().time);
        json["nyquist_mps"] = sweep.radials.front().nyquist_mps;
    }
    return json;
}

Result<Kept> wind_of(const level2::Volume& volume, const FoundVolume& found, Coding coding) {
    if (!level2::holds(volume, level2::Moment::vel))
        return fail(ErrorCode::not_found, "the volume has no velocities");
    const auto profile = retrieve::station_profile(volume, found.entry.path.filename().string());
    if (!profile) return pass_on(profile);
    // Names of files may hold any bytes.
    const auto replace = ApiJson::error_handler_t::replace;
    return kept_compressed(retrieve::profile_json(*profile).dump(-1, ' ', false, replace) + "\n",
                           coding);
}

}  // namespace

Answer api_sweeps(const ApiCall& call) {
    const auto found = find_cataloged(call);
    if (!found) return found.error();
    const auto volume = volume_of(call, *found);
    if (!volume) return volume.error();
    const auto chosen = chosen_sweeps(**volume, found->entry.station);
    ApiJson list = ApiJson::array();
    for (std::size_t i = 0; i < (*volume)->sweeps.size(); ++i)
        list.push_back(sweep_json(**volume, i, chosen));
    const auto start = (*volume)->start_time();
    return json_answer(call.request, {{"station", found->entry.station},
                                      {"time", start ? ApiJson(format_utc(*start)) : ApiJson()},
                                      {"name", found->entry.path.filename().string()},
                                      {"sweeps", list}});
}

Answer api_gates(const ApiCall& call) {
    const auto kind = whole_parameter(call, "kind", 0, 63, 0);
    if (!kind) return json_error(kind.error());
    const auto quality = number_parameter(call, "quality", 0, 1);
    if (!quality) return json_error(quality.error());
    const double least = quality->value_or(0);
    const auto moment = level2::moment_from_name(call.path_value("moment"));
    const auto sweep = range_of_text("sweep", call.path_value("sweep"));
    if (!moment || !sweep || sweep->first != sweep->second) {
        return json_error(404, "there is no such sweep or moment");
    }
    const auto found = find_cataloged(call);
    if (!found) return found.error();
    const Coding coding = coding_for(call.request);
    const std::string key =
        fmt::format("gates/{}/{}/{}/{}/{}/{}", found->key, sweep->first, call.path_value("moment"),
                    *kind, least, coding_name(coding));
    KeptAnswers& answers = *call.state.sources().kept;
    auto kept = answers.find(key);
    if (!kept) {
        const auto volume = level2::facts_of(*moment).is_derived || least > 0
                                ? derived_volume_of(call, *found, *moment, least)
                                : volume_of(call, *found);
        if (!volume) return volume.error();
        // The share that is left out is counted against all echo.
        const auto all =
            least > 0 ? volume_of(call, *found) : Answered<ApiState::DecodedVolume>{nullptr};
        if (!all) return all.error();
        auto made = answers.find_or_make(key, [&]() -> Result<Kept> {
            const auto bytes = pack_sweep(**volume, sweep->first, *moment,
                                          static_cast<std::size_t>(*kind), {least, all->get()});
            if (!bytes) return pass_on(bytes);
            return kept_compressed(*bytes, coding);
        });
        if (!made) return json_error(made.error());
        kept = std::move(*made);
    }
    return answer_with(call.request, entity_of(*kept, "application/octet-stream"));
}

Answer api_wind(const ApiCall& call) {
    const auto found = find_cataloged(call);
    if (!found) return found.error();
    const Coding coding = coding_for(call.request);
    const std::string key = fmt::format("wind/{}/{}", found->key, coding_name(coding));
    KeptAnswers& answers = *call.state.sources().kept;
    auto kept = answers.find(key);
    if (!kept) {
        if (call.must_be_quick) return takes_long();
        const auto volume = volume_of(call, *found);
        if (!volume) return volume.error();
        auto made = answers.find_or_make(key, [&] { return wind_of(**volume, *found, coding); });
        if (!made) return json_error(made.error());
        kept = std::move(*made);
    }
    Entity entity = entity_of(*kept, "application/json");
    const bool is_settled = found->entry.state == catalog::FileState::complete;
    if (is_settled && call.path_value("time") != "latest") entity.max_age = answer_holds_for;
    return answer_with(call.request, std::move(entity));
}

}  // namespace stormcellar::web
