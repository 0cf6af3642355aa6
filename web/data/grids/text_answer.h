// web/data/grids/text_answer.h -- answers with a text that is made anew for each request.
//
// Threads   Pure functions.
#pragma once

#include <string>

#include "web/http/answer.h"

namespace stormcellar::web {

// Answers with the text and an ETag of its bytes. If the text has over a kilobyte and the client
// takes a coding, it is compressed. The client must ask again each time. `headers` are more
// headers. Errors: 503 if there is no memory to compress it.
[[nodiscard]] Answer text_answer_to(const Request& request, std::string content_type,
                                    std::string text, Fields headers = {});

}  // namespace stormcellar::web
