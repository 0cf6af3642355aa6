// web/doors/raw/raw_answers.h -- makes answers with a raw volume, for several doors.
//
// Threads   Functions without state.
#pragma once

#include <optional>
#include <string_view>

#include "web/data/raw/raw_files.h"
#include "web/http/answer.h"

namespace stormcellar::web {

// Returns the entity of a volume. If the volume does not grow, clients may reuse it for a minute
// without asking again, but not longer, because it may be sent again. If the volume grows, clients
// must ask each time.
[[nodiscard]] Entity entity_of(const OpenedVolume& volume);

// Answers 404, or 410 for a deleted file, or 503 with Retry-After for a file that has changed since
// it was cataloged or that cannot be read now.
[[nodiscard]] Answer missing_answer(const RawFailure& failure);

[[nodiscard]] Answer volume_answer(const Request& request, RawFiles& files,
                                   std::string_view station, std::string_view name);
// Answers with the volume if RawFiles::open_kept() has it; else returns none.
[[nodiscard]] std::optional<Answer> volume_answer_at_once(const Request& request, RawFiles& files,
                                                          std::string_view station,
                                                          std::string_view name);

// Answers a request for /DOOR/STATION/NAME if volume_answer_at_once() has the answer. Otherwise,
// and for other paths, returns none.
[[nodiscard]] std::optional<Answer> named_volume_at_once(const Request& request, RawFiles& files);

// Reads a time in a query: one of the forms of parse_utc(), with an offset of zero, or "present".
[[nodiscard]] Result<UtcTime> time_of_parameter(std::string_view text, UtcTime now);

}  // namespace stormcellar::web
