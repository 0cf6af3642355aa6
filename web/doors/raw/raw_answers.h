// web/doors/raw/raw_answers.h -- answers with a raw volume, as several doors give them.
//
// Threads   Functions without state.
#pragma once

#include <optional>
#include <string_view>

#include "web/data/raw/raw_files.h"
#include "web/http/answer.h"

namespace stormcellar::web {

// A settled volume may be used for a minute without asking again, because it may be sent again; one
// that grows must be asked for each time.
[[nodiscard]] Entity entity_of(const OpenedVolume& volume);

// 404, 410 for a file that was deleted, and 503 with Retry-After for one that changed since it was
// cataloged or cannot be read now.
[[nodiscard]] Answer missing_answer(const RawFailure& failure);

[[nodiscard]] Answer volume_answer(const Request& request, RawFiles& files,
                                   std::string_view station, std::string_view name);
// The same for a volume that was opened just now; none: it takes longer.
[[nodiscard]] std::optional<Answer> volume_answer_at_once(const Request& request, RawFiles& files,
                                                          std::string_view station,
                                                          std::string_view name);

// A time of a query: as parse_utc(), and also with an offset of zero or as "present".
[[nodiscard]] Result<UtcTime> time_of_parameter(std::string_view text, UtcTime now);

}  // namespace stormcellar::web
