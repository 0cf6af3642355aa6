// web/http/common_headers.h -- adds headers to answers. They say which origins may read an answer
// and, except for data, restrict what a browser does with it.
//
// Threads   Pure functions.
#pragma once

#include "web/http/answer.h"
#include "web/http/request.h"

namespace stormcellar::web {

// Adds the headers. `any_origin` lets pages of other servers read the answer.
void add_common_headers(Answer& answer, const Request& request, bool any_origin);

}  // namespace stormcellar::web
