#include "web/doors/zarr/zarr.h"

#include <algorithm>
#include <utility>

#include <fmt/ranges.h>

#include "base/checksum.h"
#include "base/parse_number.h"
#include "export/cf_attributes.h"
#include "export/gzip_bytes.h"
#include "export/zarr_chunks.h"
#include "render/still/map_attributes.h"
#include "stormcellar/cache/grid_name.h"
#include "stormcellar/level2/moment.h"
#include "web/data/grids/compressed.h"
#include "web/data/grids/text_answer.h"
#include "web/data/zarr/zarr_cells.h"
#include "web/doors/pictures/picture_answers.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t segments_of_a_group = 3;  // zarr, domain, moment

Answer zarr_document(const Request& request, const ZarrJson& document) {
    return text_answer_to(request, "application/json", zarr::text_of(document));
}

Answer zarr_chunk(const Request& request, const Kept& kept,
                  std::optional<std::chrono::seconds> max_age) {
    Entity entity;
    entity.max_age = max_age;
    entity.bytes = {kept.bytes};
    entity.etag = kept.etag;
    entity.content_type = "application/octet-stream";
    return answer_with(request, std::move(entity));
}

Answer no_such_key() {
    return sentence(404, "There is no such key in this Zarr group.");
}

// `name` is the name of the group.
std::string chunk_key(const OpenGrid& grid, std::string_view name, std::string_view array,
                      const std::vector<std::size_t>& place) {
    return fmt::format("zarr/{}/{}/{}/{}/{}", grid.domain, name, grid.id, array,
                       fmt::join(place.begin() + 1, place.end(), "."));
}

std::string chunk_tag(const OpenGrid& grid, std::string_view array,
                      const std::vector<std::size_t>& place) {
    return fmt::format("\"{}-{}-{}\"", grid.id, array,
                       fmt::join(place.begin() + 1, place.end(), "."));
}

std::vector<double> seconds_of(const std::vector<UtcTime>& times) {
    std::vector<double> seconds;
    seconds.reserve(times.size());
    for (const UtcTime time : times)
        seconds.push_back(std::chrono::duration<double>(time.time_since_epoch()).count());
    return seconds;
}

Result<Kept> packed_chunk(std::string_view bytes, std::string etag) {
    auto packed = gzip_bytes(bytes, zarr::gzip_level);
    if (!packed) return pass_on(packed);
    return Kept{text_of(std::move(*packed)), std::move(etag), {}};
}

std::string made_cells(const OpenGrid& grid, const ZarrArray& array,
                       const std::vector<std::size_t>& place) {
    const ChunkPlace at{static_cast<int>(place[1]), static_cast<int>(place[2]),
                        static_cast<int>(place[3])};
    return array.number == ZarrNumber::int8 ? status_chunk(grid.file.view(), at)
                                            : value_chunk(grid.file.view(), at);
}

}  // namespace

struct ZarrDoor::Named {
    std::string domain;
    level2::Moment moment;             // whose grids have the times
    std::optional<MapStyle> map = {};  // none: all cells of the moment

    [[nodiscard]] std::string name() const {
        return map ? map->layer.name() : std::string(level2::moment_name(moment));
    }
    [[nodiscard]] std::string array() const {
        return map ? render::map_variable(map->layer.product) : name();
    }
    [[nodiscard]] int hours() const { return map ? map->layer.hours : 0; }
    // Returns the number of dimensions of the arrays that have cells or columns.
    [[nodiscard]] std::size_t dimensions() const { return map ? 3 : 4; }
};

struct ZarrDoor::Opened {
    std::shared_ptr<const std::vector<UtcTime>> times;
    std::shared_ptr<const OpenGrid> newest;
    ZarrGroup group;

    [[nodiscard]] const grid::GridSpec& spec() const { return newest->file.description().spec; }
};

std::optional<ZarrDoor::Named> ZarrDoor::named(const std::vector<std::string_view>& path) const {
    if (path.size() < segments_of_a_group) return std::nullopt;
    if (const auto moment = level2::moment_from_name(path[2]))
        return Named{std::string(path[1]), *moment};
    const auto layer = map_product_named(path[2]);
    if (!layer) return std::nullopt;
    auto style = map_style(*layer, {}, {});
    if (!style) return std::nullopt;
    const level2::Moment listed = sources_.maps->listed_moment(path[1], *layer);
    return Named{std::string(path[1]), listed, std::move(*style)};
}

Result<std::shared_ptr<const OpenGrid>> ZarrDoor::find_grid(const Named& named,
                                                            UtcTime time) const {
    return named.map ? sources_.maps->find_grid(named.domain, named.map->layer, time)
                     : sources_.grids->find(named.domain, named.moment, time);
}

// Returns true if the grid has these cells. Only the columns of a rain total count.
bool ZarrDoor::has_same_columns(const Named& named, grid::GridSpec spec, const OpenGrid& grid) {
    const grid::GridSpec& own = grid.file.description().spec;
    if (named.hours() > 0) spec.levels_m = own.levels_m;
    return spec == own;
}

// Describes the group from the newest grid. Each request does this, because it takes only
// microseconds. So nobody need tell the door about new grids.
Result<ZarrDoor::Opened> ZarrDoor::open(const Named& named) const {
    const auto present = sources_.grids->times(named.domain, named.moment);
    if (present.empty())
        return fail(ErrorCode::not_found, "There are no grids of {} in the domain {}.",
                    level2::moment_name(named.moment), named.domain);
    auto times = sources_.numbers->update(named.domain, level2::moment_name(named.moment), present);
    if (!times) return pass_on(times);
    const UtcTime newest_time =
        sources_.grids->newest(named.domain, named.moment).value_or(present.back());
    auto newest = sources_.grids->find(named.domain, named.moment, newest_time);
    if (!newest) return pass_on(newest);
    Opened opened{std::move(*times), std::move(*newest), {}};
    const cache::GridDescription& newest_grid = opened.newest->file.description();
    const std::size_t count = opened.times->size();
    opened.group = named.map ? zarr_group_of_map(named.domain, newest_grid, count, *named.map)
                             : zarr_group(named.domain, newest_grid, count);
    return opened;
}

std::optional<std::vector<std::size_t>> ZarrDoor::place_in(
    const std::vector<std::string_view>& rest, std::size_t dimensions) const {
    std::vector<std::string_view> words;
    if (version_ == ZarrVersion::three) {
        if (rest.size() != dimensions + 2 || rest[1] != "c") return std::nullopt;
        words.assign(rest.begin() + 2, rest.end());
    } else {
        if (rest.size() != 2) return std::nullopt;
        std::string_view key = rest[1];
        while (true) {
            const std::size_t dot = key.find('.');
            words.push_back(key.substr(0, dot));
            if (dot == std::string_view::npos) break;
            key.remove_prefix(dot + 1);
        }
        if (dimensions == 0) {
            if (rest[1] != "0") return std::nullopt;
            words.clear();
        }
        if (words.size() != dimensions) return std::nullopt;
    }
    std::vector<std::size_t> place;
    for (const std::string_view word : words) {
        const auto number = parse_index(word);
        if (!number) return std::nullopt;
        place.push_back(*number);
    }
    return place;
}

// Returns true if the grid has the same cells as the newest grid. Returns false if the newest grid
// is not open, because opening it would take long.
bool ZarrDoor::has_cells_of_newest(const Named& named, const OpenGrid& grid) const {
    const auto time = sources_.grids->newest(named.domain, named.moment);
    if (!time) return false;
    const auto newest = sources_.grids->find_if_open(named.domain, named.moment, *time);
    return newest && has_same_columns(named, newest->file.description().spec, grid);
}

std::optional<Answer> ZarrDoor::answer_at_once(const Request& request) {
    const auto path = segments_of(request.path);
    const auto group = named(path);
    if (!group || path.size() < segments_of_a_group + 2) return std::nullopt;
    const std::vector<std::string_view> rest(path.begin() + segments_of_a_group, path.end());
    const bool is_field = rest[0] == "status" || rest[0] == group->array();
    const auto place = place_in(rest, group->dimensions());
    if (!is_field || !place) return std::nullopt;
    const auto time =
        sources_.numbers->time_of(group->domain, level2::moment_name(group->moment), (*place)[0]);
    if (!time) return std::nullopt;
    const auto grid =
        group->map ? sources_.maps->find_grid_if_open(group->domain, group->map->layer, *time)
                   : sources_.grids->find_if_open(group->domain, group->moment, *time);
    if (!grid || !has_cells_of_newest(*group, *grid)) return std::nullopt;
    const auto kept = sources_.kept->find(chunk_key(*grid, group->name(), rest[0], *place));
    if (!kept) return std::nullopt;
    return zarr_chunk(request, *kept, max_age_of("", *grid, group->hours()));
}

Answer ZarrDoor::answer(const Request& request) {
    const auto path = segments_of(request.path);
    if (path.size() == 1) return index(request);
    const auto group = named(path);
    if (!group)
        return sentence(
            404, fmt::format("There are /{0}, /{0}/DOMAIN/MOMENT and /{0}/DOMAIN/PRODUCT here.",
                             path[0]));
    const auto opened = open(*group);
    if (!opened) return picture_error(opened.error());
    const std::vector<std::string_view> rest(path.begin() + segments_of_a_group, path.end());
    if (rest.size() >= 2) {
        const ZarrArray* array = opened->group.find(rest[0]);
        if (array == nullptr) return no_such_key();
        if (const auto place = place_in(rest, array->shape.size())) {
            for (std::size_t i = 0; i < place->size(); ++i)
                if ((*place)[i] >= array->chunks_along(i)) return no_such_key();
            return chunk(request, *group, *opened, *array, *place);
        }
    }
    return document(request, *opened, rest);
}

Answer ZarrDoor::index(const Request& request) const {
    ZarrJson groups = ZarrJson::array(), products = ZarrJson::array();
    const auto group_named = [&](const std::string& domain, level2::Moment moment,
                                 std::string_view name) -> ZarrJson {
        return {{"domain", domain},
                {"moment", level2::moment_name(moment)},
                {"zarr", fmt::format("{}/zarr/{}/{}", request.base, domain, name)},
                {"zarr3", fmt::format("{}/zarr3/{}/{}", request.base, domain, name)}};
    };
    for (const std::string& domain : sources_.grids->domains()) {
        if (cache::is_part(domain)) continue;
        const auto moments = sources_.grids->moments(domain);
        for (const level2::Moment moment : moments)
            groups.push_back(group_named(domain, moment, level2::moment_name(moment)));
        for (const MapProduct& layer : sources_.maps->layers_of(domain)) {
            products.push_back(group_named(domain, layer.moment, layer.name()));
            products.back()["product"] = layer.name();
        }
    }
    return zarr_document(request,
                         {{"groups", std::move(groups)}, {"products", std::move(products)}});
}

Answer ZarrDoor::document(const Request& request, const Opened& opened,
                          const std::vector<std::string_view>& rest) const {
    const ZarrGroup& group = opened.group;
    const bool is_three = version_ == ZarrVersion::three;
    if (rest.empty())
        return sentence(404, is_three ? "This is a Zarr group: it has zarr.json."
                                      : "This is a Zarr group: it has .zmetadata and .zgroup.");
    if (rest.size() == 1) {
        if (is_three && rest[0] == "zarr.json") return zarr_document(request, zarr3_of(group));
        if (!is_three && rest[0] == ".zmetadata")
            return zarr_document(request, zmetadata_of(group));
        if (!is_three && rest[0] == ".zgroup") return zarr_document(request, {{"zarr_format", 2}});
        if (!is_three && rest[0] == ".zattrs") return zarr_document(request, group.attributes);
        return no_such_key();
    }
    const ZarrArray* array = group.find(rest[0]);
    if (array == nullptr || rest.size() != 2) return no_such_key();
    if (is_three && rest[1] == "zarr.json") return zarr_document(request, zarr3_of(*array));
    if (!is_three && rest[1] == ".zarray") return zarr_document(request, zarray_of(*array));
    if (!is_three && rest[1] == ".zattrs") return zarr_document(request, zattrs_of(*array));
    return no_such_key();
}

Answer ZarrDoor::chunk(const Request& request, const Named& named, const Opened& opened,
                       const ZarrArray& array, const std::vector<std::size_t>& place) const {
    if (place.size() == named.dimensions()) return cells(request, named, opened, array, place);
    const grid::GridSpec& spec = opened.spec();
    const netcdf::MapNames names = netcdf::map_names(spec);
    const auto made = [&]() -> std::string {
        if (place.empty()) return std::string(sizeof(std::int32_t), '\0');
        if (place.size() == 2) {
            const auto which =
                array.name == "lat" ? zarr::Position::latitude : zarr::Position::longitude;
            return zarr::position_chunk(
                spec, which, {0, static_cast<int>(place[0]), static_cast<int>(place[1])});
        }
        const std::size_t first = place[0] * array.chunk[0];
        if (array.name == "time")
            return zarr::axis_chunk(seconds_of(*opened.times), first, array.chunk[0]);
        if (array.name == "z") return zarr::axis_chunk(spec.levels_m, first, array.chunk[0]);
        return zarr::axis_chunk(
            array.name == names.y ? netcdf::row_places(spec) : netcdf::column_places(spec), first,
            array.chunk[0]);
    };
    const bool is_kept = place.size() == 2;
    const auto pack = [&]() -> Result<Kept> {
        const std::string bytes = made();
        return packed_chunk(bytes,
                            fmt::format("\"{:016x}\"", xxh3_64(std::as_bytes(std::span(bytes)))));
    };
    const auto packed = is_kept
                            ? sources_.kept->find_or_make(
                                  fmt::format("zarr/{}/{}/{}/{}/{}", named.domain,
                                              level2::moment_name(named.moment), opened.newest->id,
                                              array.name, fmt::join(place, ".")),
                                  pack)
                            : pack();
    if (!packed) return picture_error(packed.error());
    return zarr_chunk(request, *packed, {});
}

Result<Kept> ZarrDoor::made(const OpenGrid& grid, const Named& named, const ZarrArray& array,
                            const std::vector<std::size_t>& place) const {
    if (!named.map) {
        const std::string cells = made_cells(grid, array, place);
        if (Status whole = grid.file.check_whole(); !whole) return pass_on(whole);
        return packed_chunk(cells, chunk_tag(grid, array.name, place));
    }
    const auto map = sources_.maps->map_of(grid, named.map->scene);
    if (!map) return pass_on(map);
    const ChunkPlace at{0, static_cast<int>(place[1]), static_cast<int>(place[2])};
    return packed_chunk(
        array.number == ZarrNumber::int8 ? map_status_chunk(**map, at) : map_value_chunk(**map, at),
        chunk_tag(grid, array.name, place));
}

Answer ZarrDoor::cells(const Request& request, const Named& named, const Opened& opened,
                       const ZarrArray& array, const std::vector<std::size_t>& place) const {
    const UtcTime time = (*opened.times)[place[0]];
    const auto grid = find_grid(named, time);
    if (!grid && grid.error().code == ErrorCode::not_found)
        return sentence(404, fmt::format("The grid of {} was evicted. Its cells are unavailable.",
                                         format_utc(time)));
    if (!grid) return picture_error(grid.error());
    if (!has_same_columns(named, opened.spec(), **grid))
        return sentence(404,
                        fmt::format("The grid of {} has other cells than the newest one, whose "
                                    "array this is. See /api/v1/grids for it.",
                                    format_utc(time)));
    const auto kept =
        sources_.kept->find_or_make(chunk_key(**grid, named.name(), array.name, place),
                                    [&] { return made(**grid, named, array, place); });
    if (!kept) return picture_error(kept.error());
    return zarr_chunk(request, *kept, max_age_of("", **grid, named.hours()));
}

}  // namespace stormcellar::web
