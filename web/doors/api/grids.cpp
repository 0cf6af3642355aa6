// Operations that list domains and grids, and describe one grid.
#include <algorithm>
#include <cmath>

#include "stormcellar/grid/audit_row.h"
#include "stormcellar/retrieve/derived_moments.h"
#include "web/doors/api/operations.h"

namespace stormcellar::web {
namespace {

void describe_cells(const OpenGrid& grid, ApiJson& json) {
    const grid::BrickView view = grid.file.view();
    const grid::GridSpec& spec = *view.spec;
    json["projection"] = grid::projection_name(spec.projection);
    json["center"] = {spec.center_latitude_deg, spec.center_longitude_deg};
    json[spec.in_degrees() ? "spacing_deg" : "spacing_m"] =
        spec.in_degrees() ? spec.spacing_deg : spec.spacing_m;
    if (grid::facts_of(spec.projection).takes_parallels) {
        json["parallels_deg"] = spec.parallels_deg;
    }
    json["nx"] = spec.nx;
    json["ny"] = spec.ny;
    json["offset_cells"] = {spec.offset_x_cells, spec.offset_y_cells};
    json["levels_m"] = spec.levels_m;
    json["code_bytes"] = view.quantization.code_bytes;
    json["first_value"] = view.quantization.first_value;
    json["step"] = view.quantization.step;
    std::uint64_t values = 0, stored = 0;
    std::uint16_t least = 65535, greatest = 0;
    for (const grid::BrickEntry& brick : view.bricks) {
        if (brick.kind != grid::BrickKind::stored) continue;
        ++stored;
        values += brick.value_count;
        least = std::min(least, brick.min_code);
        greatest = std::max(greatest, brick.max_code);
    }
    json["cells"] = spec.cell_count();
    json["values"] = values;
    json["least"] = stored > 0 ? ApiJson(view.quantization.value_of(least)) : ApiJson();
    json["greatest"] = stored > 0 ? ApiJson(view.quantization.value_of(greatest)) : ApiJson();
    json["bricks"] = {
        {"x", view.bricks_x}, {"y", view.bricks_y}, {"z", view.bricks_z}, {"stored", stored}};
}

ApiJson sweep_times_json(const grid::Provenance& from) {
    ApiJson list = ApiJson::array();
    for (const grid::SweepTime& sweep : from.sweeps) {
        list.push_back({{"elevation_deg", sweep.elevation_deg},
                        {"start", format_utc(sweep.start)},
                        {"first_azimuth_deg", sweep.first_azimuth_deg},
                        {"degrees_per_s", sweep.degrees_per_s}});
    }
    return list;
}

ApiJson frame_parts_json(const grid::Provenance& from) {
    ApiJson list = ApiJson::array();
    for (const grid::FramePart& part : from.parts) {
        list.push_back({{"station", part.icao},
                        {"time", format_utc(part.time)},
                        // JavaScript cannot hold a number of 64 bits, so write it as text.
                        {"fingerprint", fmt::format("{:016x}", part.fingerprint)},
                        {"first_x", part.window.first_x},
                        {"first_y", part.window.first_y},
                        {"nx", part.window.nx},
                        {"ny", part.window.ny}});
    }
    return list;
}

ApiJson provenance_json(const grid::Provenance& from) {
    ApiJson json{{"source_files", from.source_files},
                 {"stations", from.stations},
                 {"method", from.method},
                 {"beam_model", from.beam_model},
                 {"averaging", from.averaging},
                 {"effects", from.effects},
                 {"predicted_error", from.predicted_error},
                 {"software_version", from.software_version},
                 {"vcp", from.vcp},
                 {"partial", from.partial},
                 {"notes", from.notes},
                 {"radar_troubles", from.radar_troubles},
                 {"left_out", from.left_out},
                 {"provisional", from.provisional},
                 {"revision", from.revision}};
    json["source_modified"] = nullptr;  // an old key, which grids no longer record
    json["recipe"] = from.recipe == 0 ? ApiJson() : ApiJson(fmt::format("{:016x}", from.recipe));
    json["sweeps"] = sweep_times_json(from);
    json["parts"] = frame_parts_json(from);
    return json;
}

// Returns null if the grid was not audited.
ApiJson audit_json_of(const OpenGrid& grid) {
    const auto& rows = grid.file.description().provenance.audit;
    if (rows.empty()) return nullptr;
    ApiJson list = ApiJson::array();
    for (const grid::AuditRow& row : rows) {
        list.push_back(
            {{"elevation_deg", row.elevation_deg},
             {"range_from_m", row.range_from_m},
             {"range_to_m", std::isfinite(row.range_to_m) ? ApiJson(row.range_to_m) : ApiJson()},
             {"sampled", row.sampled},
             {"same_status", row.same_status},
             {"count", row.count},
             {"rms", row.rms},
             {"mean", row.mean}});
    }
    const std::string_view unit = grid::difference_unit(grid.moment);
    return {
        {"unit", unit}, {"summary", grid::errors_text(grid::pooled(rows), unit)}, {"rows", list}};
}

// A grid in a list. A list is sorted by time, then name.
struct ListedGrid {
    UtcTime time;
    std::string domain;
    level2::Moment moment = level2::Moment::ref;
    // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes a defaulted <=> for a null.
    auto operator<=>(const ListedGrid&) const = default;
};

struct GridListing {
    std::vector<ListedGrid> grids;
    bool more = false;
};
GridListing list_grids(const Grids& grids, const std::vector<std::string>& domains,
                       std::optional<level2::Moment> moment, const ListedRange& range) {
    GridListing listing;
    for (const std::string& domain : domains) {
        for (const level2::Moment one : grids.moments(domain)) {
            if (moment && one != *moment) continue;
            const auto times = grids.times(domain, one, range.from, range.to);
            const std::size_t skipped = times.size() - std::min(times.size(), range.limit);
            listing.more |= skipped > 0;
            for (std::size_t i = skipped; i < times.size(); ++i)
                listing.grids.push_back({times[i], domain, one});
        }
    }
    std::ranges::sort(listing.grids);
    if (listing.grids.size() > range.limit) {
        listing.grids.erase(listing.grids.begin(),
                            listing.grids.end() - static_cast<std::ptrdiff_t>(range.limit));
        listing.more = true;
    }
    return listing;
}

}  // namespace

Answer api_domains(const ApiCall& call) {
    ApiJson list = ApiJson::array();
    if (call.state.sources().grids) {
        Grids& grids = call.grids();
        const UtcTime now = now_utc();
        for (const std::string& domain : grids.domains()) {
            ApiJson moments = ApiJson::array();
            for (const level2::Moment moment : grids.moments(domain)) {
                const auto times = grids.times(domain, moment);
                if (times.empty()) continue;
                const UtcTime newest = grids.newest(domain, moment).value_or(times.back());
                moments.push_back({{"moment", level2::moment_name(moment)},
                                   {"units", level2::moment_units(moment)},
                                   {"grids", times.size()},
                                   {"oldest", format_utc(times.front())},
                                   {"newest", format_utc(newest)},
                                   {"age_s", std::floor(seconds_between(newest, now))}});
            }
            list.push_back(
                {{"domain", domain},
                 {"part_of", cache::is_part(domain) ? ApiJson(std::string(cache::group_of(domain)))
                                                    : ApiJson()},
                 {"moments", moments}});
        }
    }
    return json_answer(call.request, {{"domains", list}});
}

Answer api_grids(const ApiCall& call) {
    const auto moment = moment_parameter(call);
    if (!moment) return json_error(moment.error());
    const auto range = range_parameters(call);
    if (!range) return json_error(range.error());
    GridListing listing;
    if (call.state.sources().grids) {
        const auto domain = call.request.parameter("domain");
        const auto domains = domain ? std::vector{std::string(*domain)} : call.grids().domains();
        listing = list_grids(call.grids(), domains, *moment, *range);
    }
    ApiJson list = ApiJson::array();
    for (const ListedGrid& grid : listing.grids) {
        list.push_back({{"domain", grid.domain},
                        {"moment", level2::moment_name(grid.moment)},
                        {"time", format_utc(grid.time)},
                        {"path", grid_path({grid.domain, grid.moment, grid.time})}});
    }
    return json_answer(call.request, {{"grids", list}, {"more", listing.more}});
}

Answer api_grid(const ApiCall& call) {
    const auto found = find_grid(call);
    if (!found) return found.error();
    const OpenGrid& grid = **found;
    const cache::GridDescription& description = grid.file.description();
    const std::string path = grid_path({grid.domain, grid.moment, grid.time});
    ApiJson json{{"domain", grid.domain},
                 {"moment", level2::moment_name(grid.moment)},
                 {"units", level2::moment_units(grid.moment)},
                 {"time", format_utc(grid.time)},
                 {"start_time", format_utc(description.start_time)},
                 {"end_time", format_utc(description.end_time)},
                 {"id", grid.id},
                 {"bytes", grid.file.bytes()},
                 {"bytes_on_disk", grid.file.bytes_on_disk()}};
    describe_cells(grid, json);
    json["sites"] = ApiJson::array();
    for (const grid::SitePosition& site : description.sites) {
        json["sites"].push_back({{"icao", site.icao},
                                 {"latitude_deg", site.latitude_deg},
                                 {"longitude_deg", site.longitude_deg},
                                 {"altitude_m", site.altitude_m}});
    }
    json["provenance"] = provenance_json(description.provenance);
    const std::string quality = retrieve::quality_in_notes(description.provenance.notes);
    json["quality"] = quality.empty() ? ApiJson() : ApiJson(quality);
    json["audit"] = audit_json_of(grid);
    json["links"] = {{"packed", path + "/packed?id=" + grid.id},
                     {"probe", path + "/probe"},
                     {"profile", path + "/profile"},
                     {"netcdf", path + "/netcdf"},
                     {"file", path + "/file"}};
    return json_answer(call.request, json);
}

}  // namespace stormcellar::web
