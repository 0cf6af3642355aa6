// web/doors/raw/raw_answers.h -- answers with a raw volume, shared by several doors.
//
// Threads   Functions without state.
#pragma once

#include <optional>
#include <string_view>

#include "web/data/raw/raw_files.h"
#include "web/http/answer.h"

namespace stormcellar::web {

// Returns the entity of a volume. Clients may use a volume that does not grow for a minute without
// asking again. They may not use it longer, because the volume may be sent again. Clients must ask
// each time for a growing volume.
[[nodiscard]] Entity entity_of(const OpenedVolume& volume);

// Answers 404, 410 for a deleted file, and 503 with Retry-After for a file that changed since it
// was cataloged or that cannot be read now.
[[nodiscard]] Answer missing_answer(const RawFailure& failure);

[[nodiscard]] Answer volume_answer(const Request& request, RawFiles& files,
                                   std::string_view station, std::string_view name);
// Answers with the volume if RawFiles::open_kept() returns it; returns none otherwise.
[[nodiscard]] std::optional<Answer> volume_answer_at_once(const Request& request, RawFiles& files,
                                                          std::string_view station,
                                                          std::string_view name);

// Answers a request for /DOOR/STATION/NAME if volume_answer_at_once() has the answer; returns none
// for other paths.
[[nodiscard]] std::optional<Answer> named_volume_at_once(const Request& request, RawFiles& files);

// Reads a time of a query: the forms of parse_utc(), an offset of zero, or "present".
[[nodiscard]] Result<UtcTime> time_of_parameter(std::string_view text, UtcTime now);

}  // namespace stormcellar::web
