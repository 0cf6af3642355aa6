#include "web/doors/zarr/station_door.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/checksum.h"
#include "base/parse_number.h"
#include "export/zarr_chunks.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/catalog/read_cataloged.h"
#include "web/data/grids/compressed.h"
#include "web/data/grids/text_answer.h"
#include "web/data/pictures/map_product.h"
#include "web/doors/pictures/picture_answers.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t segments_before_groups = 3;  // zarr3, volumes, station
constexpr std::string_view sweep_prefix = "sweep_";
// The notes of a kept answer that says that a chunk has only fill values.
constexpr std::string_view only_fill = "fill";

// Returns the indices in a key such as c/0/1 of this array; none if it has no such chunk.
std::optional<std::vector<std::size_t>> chunk_indices(std::span<const std::string_view> key,
                                                      const ZarrArray& array) {
    if (key.size() != array.shape.size() + 1 || key.front() != "c") return std::nullopt;
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < array.shape.size(); ++i) {
        const auto index = parse_index(key[i + 1]);
        if (!index || *index >= array.chunks_along(i)) return std::nullopt;
        indices.push_back(*index);
    }
    return indices;
}

Answer no_such_station_key() {
    return sentence(404, "There is no such key in this Zarr tree.");
}

Answer no_values(std::string_view why) {
    return sentence(404, fmt::format("There are no values: {}", why));
}

Result<Kept> zstd_chunk(std::string_view bytes) {
    auto packed = zstd_packed(bytes, zarr::zstd_level);
    if (!packed) return pass_on(packed);
    return Kept{text_of(std::move(*packed)),
                fmt::format("\"{:016x}\"", xxh3_64(std::as_bytes(std::span(bytes)))),
                {}};
}

Answer chunk_answer(const Request& request, const Kept& kept,
                    std::optional<std::chrono::seconds> max_age = {}) {
    if (kept.notes == only_fill) return no_values("the volume does not have this sweep or moment.");
    Entity entity;
    entity.bytes = {kept.bytes};
    entity.etag = kept.etag;
    entity.content_type = "application/octet-stream";
    entity.max_age = max_age;
    return answer_with(request, std::move(entity));
}

// A chunk that cannot be made because of the file has no values. Other causes may end.
Answer failed_chunk(const Error& error) {
    if (error.cause() == Cause::data || error.code == ErrorCode::not_found ||
        error.code == ErrorCode::not_a_file)
        return no_values("the file of the volume is gone, damaged or has changed.");
    return picture_error(error);
}

std::string vcp_times_chunk(const std::vector<UtcTime>& times, std::size_t chunk) {
    std::vector<std::int64_t> milliseconds(times_of_a_chunk, no_time_ms);
    const std::size_t first = chunk * times_of_a_chunk;
    for (std::size_t i = 0; i < milliseconds.size() && first + i < times.size(); ++i)
        milliseconds[i] = times[first + i].time_since_epoch().count();
    return zarr::bytes_of(milliseconds);
}

}  // namespace

struct StationDoor::Named {
    std::string path;
    const ZarrGroup* group = nullptr;
    const StationPattern* pattern = nullptr;  // null: the root
    std::size_t place = 0;                    // of a group of a sweep
    std::span<const std::string_view> rest = {};

    // Finds the group that the longest part of the path names. The root matches every path.
    static Named in(const StationTree& tree, std::span<const std::string_view> path) {
        for (std::size_t depth = std::min<std::size_t>(2, path.size());; --depth) {
            Named named{.path = fmt::format("{}", fmt::join(path.first(depth), "/"))};
            const auto group = std::ranges::find(tree.groups, named.path,
                                                 [](const auto& one) { return one.first; });
            if (group == tree.groups.end()) continue;
            named.group = &group->second;
            named.rest = path.subspan(depth);
            if (depth > 0)
                named.pattern = &*std::ranges::find(tree.patterns, path[0], &StationPattern::name);
            if (depth == 2)
                named.place = parse_index(path[1].substr(sweep_prefix.size())).value_or(0);
            return named;
        }
    }
};

std::optional<Answer> StationDoor::answer_of(const Request& request, bool must_be_quick) {
    const auto path = segments_of(request.path);
    if (path.size() < segments_before_groups) return stations_index(request);
    const std::string_view station = path[2];
    if (level2::moment_from_name(station) || map_product_named(station))
        return grids_->answer(request);
    StationTrees::Tree tree = trees_->find_fresh(station);
    if (!tree) {
        const auto stations = trees_->stations();
        if (!stations) return picture_error(stations.error());
        if (!std::ranges::binary_search(*stations, station))
            return sentence(404, "There are no volumes of this station.");
        if (must_be_quick) return std::nullopt;
        auto made = trees_->open(station);
        if (!made) return picture_error(made.error());
        tree = std::move(*made);
    }
    return answer_in(request, *tree, std::span(path).subspan(segments_before_groups),
                     must_be_quick);
}

Answer StationDoor::stations_index(const Request& request) const {
    const auto stations = trees_->stations();
    if (!stations) return json_error(stations.error());
    ZarrJson list = ZarrJson::array();
    for (const std::string& station : *stations)
        list.push_back(ZarrJson::object(
            {{"station", station},
             {"zarr3", fmt::format("{}/zarr3/volumes/{}", request.base, station)}}));
    return text_answer_to(request, "application/json",
                          zarr::text_of(ZarrJson::object({{"stations", std::move(list)}})));
}

std::optional<Answer> StationDoor::answer_in(const Request& request, const StationTree& tree,
                                             std::span<const std::string_view> path,
                                             bool must_be_quick) {
    constexpr std::string_view document = "zarr.json", json = "application/json";
    const Named named = Named::in(tree, path);
    if (named.rest.empty()) return sentence(404, "This is a Zarr group: it has zarr.json.");
    if (named.rest.size() == 1) {
        if (named.rest[0] != document) return no_such_station_key();
        return text_answer_to(request, std::string(json),
                              zarr::text_of(zarr3_of(tree.groups, named.path)));
    }
    const ZarrArray* const array = named.group->find(named.rest[0]);
    if (array == nullptr) return no_such_station_key();
    if (named.rest.size() == 2 && named.rest[1] == document)
        return text_answer_to(request, std::string(json), zarr::text_of(zarr::zarr3_of(*array)));
    const auto indices = chunk_indices(named.rest.subspan(1), *array);
    if (!indices) return no_such_station_key();
    return chunk(request, tree, named, *array, *indices, must_be_quick);
}

std::optional<Answer> StationDoor::chunk(const Request& request, const StationTree& tree,
                                         const Named& named, const ZarrArray& array,
                                         std::span<const std::size_t> place, bool must_be_quick) {
    if (place.size() > 1)
        return sweep_chunk(request, tree, named, array, place.front(), must_be_quick);
    const auto bytes = [&]() -> std::string {
        if (named.pattern == nullptr) return root_chunk(tree.facts, array.name);
        if (array.name == "vcp_time") return vcp_times_chunk(*named.pattern->times, place.front());
        return place_chunk(named.pattern->places->all()[named.place], named.place, array.name);
    };
    const auto packed = zstd_chunk(bytes());
    if (!packed) return picture_error(packed.error());
    return chunk_answer(request, *packed);
}

std::optional<Answer> StationDoor::sweep_chunk(const Request& request, const StationTree& tree,
                                               const Named& named, const ZarrArray& array,
                                               std::size_t time, bool must_be_quick) {
    const catalog::CatalogEntry* const volume = named.pattern->volume_at(time);
    if (volume == nullptr) return no_values("the volume has left the catalog.");
    const SweepPlace& place = named.pattern->places->all()[named.place];
    const auto wanted = sweep_array_of(place, array.name);
    const auto volume_key = key_of_volume(*tree.catalog, *volume);
    if (!wanted || !volume_key)
        return wanted ? picture_error(volume_key.error()) : no_such_station_key();
    // A tree that is made again may have the kinds of sweeps in another order.
    const std::string key = fmt::format(
        "volumes/{}/{:.3f}/{}/{}/{}/{}", *volume_key, place.kind.angle_deg, place.kind.has_velocity,
        place.occurrence, array.name, fmt::join(array.shape.begin() + 1, array.shape.end(), "x"));
    const bool is_settled =
        volume->state == catalog::FileState::complete && catalog::has_final_hash(*volume);
    const auto max_age = is_settled ? std::optional(answer_holds_for) : std::nullopt;
    if (const auto kept = kept_->find(key)) return chunk_answer(request, *kept, max_age);
    if (must_be_quick) return std::nullopt;
    const auto made = kept_->find_or_make(key, [&]() -> Result<Kept> {
        const auto found = trees_->find_sweep(tree, *named.pattern, *volume, named.place);
        if (!found) return pass_on(found);
        const auto bytes =
            found->sweep == nullptr ? std::nullopt : chunk_of(*found->sweep, place, *wanted);
        if (!bytes) return Kept{text_of({}), {}, std::string(only_fill)};
        return zstd_chunk(*bytes);
    });
    if (!made) return failed_chunk(made.error());
    return chunk_answer(request, *made, max_age);
}

}  // namespace stormcellar::web
