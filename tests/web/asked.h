// tests/web/asked.h -- sends requests to doors (handlers of paths) without a server, and reads
// answers.
#pragma once

#include <string>
#include <string_view>

#include "web/http/door.h"

namespace stormcellar::web {

// Returns a request for a path with a query, as the server would pass it on.
[[nodiscard]] Request request_for(std::string_view target, Fields headers = {});
// Calls the door as the server does: calls answer_at_once(), and then answer() if answer_at_once()
// returns none.
[[nodiscard]] Answer asked(Door& door, std::string_view target, Fields headers = {});
[[nodiscard]] std::string body_of(const Answer& answer);
// Returns the first header of this name; empty if there is none.
[[nodiscard]] std::string header_of(const Answer& answer, std::string_view name);

}  // namespace stormcellar::web
