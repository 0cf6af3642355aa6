// web/doors/pictures/picture_answers.h -- code that the doors of pictures and grids share: finding
// a grid by name, and answering with a picture.
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

// Answers with the status that fits the error, and its sentence; 503 has Retry-After.
[[nodiscard]] Answer picture_error(const Error& error);

// The value that a request asks for, or the answer that refuses it.
template <class Value>
using Found = tl::expected<Value, Answer>;

// Finds the grid for "latest" or for an instant. Refusals: 404, 410 for an evicted grid, 400 for a
// text that is not a time, and the answer to an error of reading the grid.
[[nodiscard]] Found<std::shared_ptr<const OpenGrid>> grid_named(Grids& grids,
                                                                std::string_view domain,
                                                                level2::Moment moment,
                                                                std::string_view time);

// Answers with a picture that depends only on its address and the grid's bytes; its notes are its
// media type. A client may reuse the picture for `max_age`; none: it must revalidate each use.
[[nodiscard]] Answer picture_answer(const Request& request, const Kept& picture,
                                    std::optional<std::chrono::seconds> max_age);
// Returns 304 if the client has the picture with this tag; none otherwise.
[[nodiscard]] std::optional<Answer> unchanged_answer(const Request& request,
                                                     const std::string& etag,
                                                     std::optional<std::chrono::seconds> max_age);

// Time for which clients may reuse an answer that depends only on a grid, without revalidating it.
inline constexpr std::chrono::seconds answer_holds_for{300};
// Returns `answer_holds_for`, or none (revalidate) for a grid that was requested as "latest" or
// that may change.
[[nodiscard]] std::optional<std::chrono::seconds> max_age_of(std::string_view time,
                                                             const OpenGrid& grid);

}  // namespace stormcellar::web
