// web/doors/pictures/picture_answers.h -- what the doors of pictures and grids share: a grid by its
// name, and answers with a picture.
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
#include "web/http/answer.h"

namespace stormcellar::web {

// The status that fits the error, and its sentence; 503 with Retry-After.
[[nodiscard]] Answer picture_error(const Error& error);

// The value that a request asks for, or the answer that refuses it.
template <class Value>
using Found = tl::expected<Value, Answer>;

// "latest" or the instant of a grid. Refusals: 404, 410 for a grid that was evicted, 400 for a text
// that is no time.
[[nodiscard]] Found<std::shared_ptr<const OpenGrid>> grid_named(Grids& grids,
                                                                std::string_view domain,
                                                                level2::Moment moment,
                                                                std::string_view time);

// A picture that follows from its address and the grid's bytes; its notes are its media type. A
// client may use it for `max_age` without asking again; none: it must ask.
[[nodiscard]] Answer picture_answer(const Request& request, const Kept& picture,
                                    std::optional<std::chrono::seconds> max_age);
// 304 if the client has the picture of this tag; none otherwise.
[[nodiscard]] std::optional<Answer> unchanged_answer(const Request& request,
                                                     const std::string& etag,
                                                     std::optional<std::chrono::seconds> max_age);

// Clients may use an answer that follows from a grid for this long without asking again.
inline constexpr std::chrono::seconds answer_holds_for{300};
// Returns none (ask each time) for a grid that was asked for as "latest" or that may change.
[[nodiscard]] std::optional<std::chrono::seconds> max_age_of(std::string_view time,
                                                             const OpenGrid& grid);

}  // namespace stormcellar::web
