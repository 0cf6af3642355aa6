// web/data/grids/text_answer.h -- answers with a text that is made for each request.
//
// Threads   Pure functions.
#pragma once

#include <string>

#include "web/http/answer.h"

namespace stormcellar::web {

// Answers with the text and an ETag of its bytes. A text of over a kilobyte is compressed if the
// client accepts a coding. The client must revalidate each use. `headers` are added to the answer.
// Errors: 503 if there is no memory to compress it.
[[nodiscard]] Answer text_answer_to(const Request& request, std::string content_type,
                                    std::string text, Fields headers = {});

}  // namespace stormcellar::web
