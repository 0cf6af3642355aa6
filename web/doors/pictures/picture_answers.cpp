#include "web/doors/pictures/picture_answers.h"

#include <utility>

#include "base/printable.h"

namespace stormcellar::web {
namespace {

constexpr std::chrono::seconds drawing_again_in{2};
// Look first among grids this new, which usually have the answer, before listing all times.
constexpr std::chrono::hours looked_at_first{2};

Answer no_such_grid(Grids& grids, std::string_view domain, level2::Moment moment, UtcTime time) {
    const std::string what =
        fmt::format("The grid of {}, {}, at {}", printable(domain.substr(0, 80)),
                    level2::moment_name(moment), format_utc(time));
    if (grids.was_evicted(domain, moment, time))
        return sentence(410, what + " was evicted from the cache.");
    return sentence(404, what + " is not in the cache.");
}

using FoundGrid = Found<std::shared_ptr<const OpenGrid>>;

// `moment` has the times of the grids that `find` finds.
template <class Find>
FoundGrid found_at(Grids& grids, std::string_view domain, level2::Moment moment,
                   std::string_view time, Find find) {
    const auto instant = time_of_grid(grids, domain, moment, time);
    if (!instant) return tl::unexpected(picture_error(instant.error()));
    auto grid = find(*instant);
    if (grid) return std::move(*grid);
    if (grid.error().code == ErrorCode::not_found)
        return tl::unexpected(no_such_grid(grids, domain, moment, *instant));
    return tl::unexpected(picture_error(grid.error()));
}

}  // namespace

Answer picture_error(const Error& error) {
    const unsigned status = status_of(error);
    const std::string text = without_paths(error.message);
    return with_trouble(status == 503 ? come_back(drawing_again_in, text) : sentence(status, text),
                        error);
}

Found<std::shared_ptr<const OpenGrid>> grid_named(Grids& grids, std::string_view domain,
                                                  level2::Moment moment, std::string_view time) {
    return found_at(grids, domain, moment, time,
                    [&](UtcTime instant) { return grids.find(domain, moment, instant); });
}

Found<std::shared_ptr<const OpenGrid>> total_named(Grids& grids, RainTotals& rain,
                                                   std::string_view domain, int hours,
                                                   std::string_view time) {
    return found_at(
        grids, domain, RainTotals::listed_moment(grids, domain), time,
        [&](UtcTime instant) { return rain.find(std::string(domain), hours, instant); });
}

Found<std::shared_ptr<const OpenGrid>> grid_named(MapPictures& pictures, std::string_view domain,
                                                  const MapProduct& layer, std::string_view time) {
    return found_at(pictures.grids(), domain, pictures.listed_moment(domain, layer), time,
                    [&](UtcTime instant) { return pictures.find_grid(domain, layer, instant); });
}

std::optional<GridOfSweep> grid_of_sweep(const Grids& grids, std::string_view domain,
                                         std::optional<UtcTime> until) {
    std::optional<GridOfSweep> newest;
    for (const level2::Moment moment : grids.moments(domain)) {
        std::optional<UtcTime> time = grids.newest(domain, moment);
        if (time && until) {
            auto times = grids.times(domain, moment, *until - looked_at_first, until);
            if (times.empty()) times = grids.times(domain, moment, {}, until);
            time = times.empty() ? std::nullopt : std::optional(times.back());
        }
        if (time && (!newest || *time > newest->time)) newest = {*time, moment};
    }
    return newest;
}

Found<SweepPicture> sweep_of_grid(SweepPictures& sweeps, const OpenGrid& grid, FrameStyle style) {
    auto picture = sweeps.find(grid, std::move(style));
    if (!picture) return tl::unexpected(picture_error(picture.error()));
    if (!*picture) {
        return tl::unexpected(
            sentence(404, fmt::format("A ppi is drawn of the raw volume, and the catalog has none "
                                      "that starts at {}.",
                                      format_utc(grid.time))));
    }
    if ((*picture)->volume.state == catalog::FileState::gone) {
        return tl::unexpected(
            sentence(410, "A ppi is drawn of the raw volume, and its file is gone."));
    }
    return std::move(**picture);
}

Answer picture_answer(const Request& request, const Kept& picture,
                      std::optional<std::chrono::seconds> max_age) {
    Entity entity;
    entity.bytes = {picture.bytes};
    entity.content_type = picture.notes;
    entity.etag = picture.etag;
    entity.max_age = max_age;
    return answer_with(request, std::move(entity));
}

std::optional<Answer> unchanged_answer(const Request& request, const std::string& etag,
                                       std::optional<std::chrono::seconds> max_age) {
    if (!request.header("If-None-Match")) return std::nullopt;
    Entity entity;
    entity.etag = etag;
    entity.max_age = max_age;
    Answer answer = answer_with(request, std::move(entity));
    return answer.status == 304 ? std::optional(std::move(answer)) : std::nullopt;
}

std::optional<Answer> kept_map_answer(const Request& request, MapPictures& pictures,
                                      const MapPicture& picture,
                                      std::optional<std::chrono::seconds> max_age) {
    if (auto unchanged = unchanged_answer(request, picture.etag(), max_age)) return unchanged;
    const auto kept = pictures.find(picture);
    if (!kept) return std::nullopt;
    return picture_answer(request, *kept, max_age);
}

Answer map_answer(const Request& request, MapPictures& pictures, const MapPicture& picture,
                  std::optional<std::chrono::seconds> max_age) {
    if (auto unchanged = unchanged_answer(request, picture.etag(), max_age)) return *unchanged;
    const auto drawn = pictures.find_or_draw(picture);
    if (!drawn) return picture_error(drawn.error());
    return picture_answer(request, *drawn, max_age);
}

std::optional<std::chrono::seconds> max_age_of(std::string_view time, const OpenGrid& grid,
                                               int hours) {
    if (time == "latest" || grid.may_change() || hours > 0) return std::nullopt;
    return answer_holds_for;
}

}  // namespace stormcellar::web
