// web/http/common_headers.h -- adds headers to answers. They say which origins may read an answer
// and, for pages and scripts, restrict what a browser does with it.
//
// Threads   Pure functions.
#pragma once

#include <string>
#include <vector>

#include "web/http/answer.h"
#include "web/http/request.h"

namespace stormcellar::web {

// Rules for pages of other origins.
struct OriginRules {
    bool any_may_read = false;          // pages of all origins may read answers
    std::vector<std::string> embed_in;  // origins whose pages may show ours in a frame
};

void add_common_headers(Answer& answer, const Request& request, const OriginRules& origins);

}  // namespace stormcellar::web
