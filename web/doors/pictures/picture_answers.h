// web/doors/pictures/picture_answers.h -- code that several doors share: finds a grid by name, and
// answers with a picture.
//
// Threads   Functions without state.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string_view>

#include "stormcellar/base/result.h"
#include "web/data/grids/grids.h"
#include "web/data/grids/kept_answers.h"
#include "web/data/pictures/map_pictures.h"
#include "web/data/pictures/sweep_pictures.h"
#include "web/data/storms/rain_totals.h"
#include "web/http/answer.h"

namespace stormcellar::web {

// Answers with the status that fits the error, and with its sentence. A 503 has Retry-After.
[[nodiscard]] Answer picture_error(const Error& error);

// The value that a request asks for, or the answer that refuses it.
template <class Value>
using Found = tl::expected<Value, Answer>;

// Finds the grid of "latest" or of an instant. Refuses with 404, with 410 for an evicted grid, with
// 400 for a text that is not a time, or with the error of reading the grid.
[[nodiscard]] Found<std::shared_ptr<const OpenGrid>> grid_named(Grids& grids,
                                                                std::string_view domain,
                                                                level2::Moment moment,
                                                                std::string_view time);

// The same for the grid of a layer: a kept grid, or a rain total. A total that is not ready yet is
// refused with 503.
[[nodiscard]] Found<std::shared_ptr<const OpenGrid>> grid_named(MapPictures& pictures,
                                                                std::string_view domain,
                                                                const MapProduct& layer,
                                                                std::string_view time);
// The same for a rain total of these hours.
[[nodiscard]] Found<std::shared_ptr<const OpenGrid>> total_named(Grids& grids, RainTotals& rain,
                                                                 std::string_view domain, int hours,
                                                                 std::string_view time);

// A grid whose raw volume has the sweep to show.
struct GridOfSweep {
    UtcTime time;
    level2::Moment moment;
};
// Returns the newest grid of any moment at `until` or before, or none. Without `until`, returns
// the newest grid by newest_believed().
[[nodiscard]] std::optional<GridOfSweep> grid_of_sweep(const Grids& grids, std::string_view domain,
                                                       std::optional<UtcTime> until);
// Finds the raw volume of the grid. Refuses with 404 if the catalog has none, with 410 if its file
// is gone, or with the error of SweepPictures::find().
[[nodiscard]] Found<SweepPicture> sweep_of_grid(SweepPictures& sweeps, const OpenGrid& grid,
                                                FrameStyle style);

// Answers with a picture that depends only on its address and the grid's bytes. The notes of `kept`
// are the media type. The client may reuse the picture for `max_age`; none: the client must
// revalidate each use.
[[nodiscard]] Answer picture_answer(const Request& request, const Kept& picture,
                                    std::optional<std::chrono::seconds> max_age);
// Returns 304 if the client already has the picture with this tag, else none.
[[nodiscard]] std::optional<Answer> unchanged_answer(const Request& request,
                                                     const std::string& etag,
                                                     std::optional<std::chrono::seconds> max_age);

// Returns 304 if the client has the picture, or the picture if it is kept. Otherwise returns none.
[[nodiscard]] std::optional<Answer> kept_map_answer(const Request& request, MapPictures& pictures,
                                                    const MapPicture& picture,
                                                    std::optional<std::chrono::seconds> max_age);
// Returns 304 or the picture, drawn if it is not kept, or the answer that says why it cannot be
// drawn.
[[nodiscard]] Answer map_answer(const Request& request, MapPictures& pictures,
                                const MapPicture& picture,
                                std::optional<std::chrono::seconds> max_age);

// For this time, clients may reuse an answer that depends only on a grid, without asking again.
inline constexpr std::chrono::seconds answer_holds_for{300};
// Returns `answer_holds_for`. Returns none (the client must revalidate) if the grid was requested
// as "latest" or may change, as do rain totals, whose older grids may be made again.
[[nodiscard]] std::optional<std::chrono::seconds> max_age_of(std::string_view time,
                                                             const OpenGrid& grid, int hours = 0);

}  // namespace stormcellar::web
