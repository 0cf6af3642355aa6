// web/http/common_headers.h -- what every answer has: what a browser must not do with it, and who
// may read it.
//
// Threads   Pure functions.
#pragma once

#include "web/http/answer.h"
#include "web/http/request.h"

namespace stormcellar::web {

// `any_origin`: the pages of other servers may read it.
void add_common_headers(Answer& answer, const Request& request, bool any_origin);

}  // namespace stormcellar::web
