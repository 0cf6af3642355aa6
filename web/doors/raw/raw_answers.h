// web/doors/raw/raw_answers.h -- answers with a raw volume, shared by several doors.
//
// Threads   Functions without state.
#pragma once

#include <optional>
#include <string_view>

#include "web/data/raw/raw_files.h"
#include "web/http/answer.h"

namespace stormcellar::web {

// Returns the entity of a volume. Clients may use a settled volume for only a minute without asking
// again, because it may be sent again. They must ask for a growing volume each time.
[[nodiscard]] Entity entity_of(const OpenedVolume& volume);

// Answers 404, 410 for a deleted file, and 503 with Retry-After for a file that changed since it
// was cataloged or that cannot be read now.
[[nodiscard]] Answer missing_answer(const RawFailure& failure);

[[nodiscard]] Answer volume_answer(const Request& request, RawFiles& files,
                                   std::string_view station, std::string_view name);
// Answers with a volume that RawFiles::open_kept() still has; else none.
[[nodiscard]] std::optional<Answer> volume_answer_at_once(const Request& request, RawFiles& files,
                                                          std::string_view station,
                                                          std::string_view name);

// Does the same for a request for /DOOR/STATION/NAME; none for other paths.
[[nodiscard]] std::optional<Answer> named_volume_at_once(const Request& request, RawFiles& files);

// Reads a time of a query: the forms of parse_utc(), an offset of zero, or "present".
[[nodiscard]] Result<UtcTime> time_of_parameter(std::string_view text, UtcTime now);

}  // namespace stormcellar::web
